"""The page of claims: what each statement of the paper says, and what was measured of it."""

from html import escape

from reading import ledger
from writing import markup, tables

TITLE = "Asymptotic compatibility: claim by claim"
ABOUT = """Every statement of the theory in the order of the paper, with all that was measured of it and the worst of
it. The verdict is that of the worst. A statement that is <em>not so as printed</em> is expected to fail somewhere, and
a remark with its findings says why and what holds instead. A negative control is a case in which the statement must
fail, because one of its assumptions does, or in which an error must settle; it shows that the measurement would see a
failure, and counts as no evidence for the statement."""

COLUMNS = ("statement", "what it says", "measured on", "worst observed", "verdict", "as expected", "figures")


def html(studies, drawings):
    """The page as text. `drawings`: {name of a study: its drawings}."""
    of_paper, further = ledger.ledger(studies)
    every = [entry for statement in (*of_paper, *further) for entry in statement.entries]
    checked = [study for study in studies if study.kind in ledger.OF_MEASUREMENT and study.findings]
    controls = [finding for study in checked for finding in study.findings]
    body = [markup.outcome({"results": sum(not result.as_expected for result in (*every, *controls))},
                           {"results": len(every) + len(controls)})]
    for heading, statements in (("Statements of the paper", of_paper), ("Further findings", further)):
        if statements:
            rows = "".join(_row(statement, drawings) for statement in statements)
            body.append(f"<section>\n<h2>{heading}</h2>\n{markup.table(COLUMNS, rows, heading)}</section>\n")
    if checked:
        body.append(f"<section>\n<h2>What the measurement itself is held to</h2>\n{''.join(map(_checked, checked))}"
                    "</section>\n")
    if every:
        body.append('<section>\n<h2>Every finding</h2>\n')
        body += [_every(statement) for statement in (*of_paper, *further)]
        body.append("</section>\n")
    links = [("index.html", "all studies")]
    links += [(f"#{_anchor(statement)}", statement.name) for statement in of_paper]
    return markup.document(TITLE, ABOUT, links, "".join(body))


def _row(statement, drawings):
    worst = statement.worst
    subjects = len({entry.subject for entry in statement.tested})
    checks = len({entry.check for entry in statement.tested})
    counts = [_number(len(statement.tested), "finding"), _number(subjects, "subject"), _number(checks, "condition")]
    measured = ", ".join(counts) if statement.tested else ""
    if statement.controls:
        caught = sum(entry.as_expected for entry in statement.controls)
        measured += (f'<br><span class="note">negative controls: {caught} of {len(statement.controls)} fail or '
                     "settle as they must</span>")
    verdict = markup.badge(worst, worst.control)
    if statement.unsharp:
        measured += (f'<br><span class="note">{_number(len(statement.unsharp), "finding")} more: a bound is not '
                     "attained</span>")
    if statement.refuted and not statement.departing:
        verdict = '<span class="badge bad">not so as printed</span>'
        measured += (f'<br><span class="note">{len(statement.refuted)} of {len(statement.tested)} show that it does not '
                     "hold as printed</span>")
    if statement.departing:
        said = f"<strong>{len(statement.departing)} of {len(statement.entries)} not</strong>"
    else:
        said = "all"
    claims = "<br>".join(escape(claim) for claim in statement.claims)
    return (f'<tr{markup.departs_if(statement.departing)}>'
            f'<th scope="row"><a href="#{_anchor(statement)}">{escape(statement.name)}</a></th>'
            f'<td class="said">{claims}</td><td class="said">{measured}</td><td class="said">{tables.worst_observed(statement)}</td>'
            f"<td>{verdict}</td><td>{said}</td><td>{_figures(statement, drawings)}</td></tr>\n")


def _figures(statement, drawings):
    links = {}
    for study in dict.fromkeys(entry.study.name for entry in statement.entries):
        of_study = drawings.get(study, [])
        shown = [drawing for drawing in of_study if statement.name in drawing.statements]
        for drawing in shown or [drawing for drawing in of_study if not drawing.statements][:1]:
            links[drawing.stem] = f'<a href="index.html#{escape(drawing.stem)}.figure">{escape(drawing.stem)}</a>'
        if not of_study:
            links[study] = f'<a href="index.html#{study}">{study}</a>'
    return "<br>".join(links.values())


def _every(statement):
    remarks = dict.fromkeys(entry.remark for entry in statement.entries if entry.remark)
    notes = "".join(f"<p>{escape(remark)}</p>\n" for remark in remarks)
    opened = " open" if statement.departing else ""
    return (f'<details id="{_anchor(statement)}"{opened}><summary>{escape(statement.name)} '
            f'<span class="note">{_number(len(statement.entries), "finding")}</span></summary>\n'
            f"{notes}{tables.entry_table(statement.entries, statement.name)}</details>\n")


def _checked(study):
    right = sum(finding.as_expected for finding in study.findings)
    if study.kind == "corpus":
        text = f"{right} of {_number(len(study.findings), 'synthetic series')} of known order get the right verdict."
    else:
        wrong = {finding.subject for finding in study.findings if finding.control}
        accused = {finding.subject for finding in study.findings if finding.alarm}
        text = (f"{len(accused & wrong)} of {_number(len(wrong), 'wrong scheme')} and {len(accused - wrong)} true ones "
                f"raise an alarm; {right} of {len(study.findings)} cells are as expected.")
    return f'<p><a href="index.html#{study.name}">{escape(study.title)}</a>: {text}</p>\n'


def corpus_table(study):
    """A row per synthetic series: what is right, and what it got."""
    rows = "".join(
        f'<tr{markup.departs(finding)}><th scope="row">{escape(finding.subject)}</th>'
        f'<td class="said">{escape(finding.claim)}</td><td class="number">{finding.theory_order:g}</td>'
        f"<td>{escape(' or '.join((finding.expected, *finding.also_expected)))}</td>"
        f"<td>{markup.badge(finding)}</td><td>{'yes' if finding.as_expected else '<strong>no</strong>'}</td></tr>\n"
        for finding in study.findings)
    columns = ("series", "why", "theory's order", "right verdict", "given verdict", "right")
    return markup.table(columns, rows, study.title)


def _anchor(statement):
    return "claim-" + "".join(c if c.isalnum() else "-" for c in statement.name).strip("-")


def _number(n, noun):
    return f"{n} {noun}" + ("" if n == 1 or noun.endswith("s") else "s")
