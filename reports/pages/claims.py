"""The page of claims: what each statement of the paper says, and what was measured of it."""

from html import escape

from kinds import registry
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
    of_paper, further = statements(studies)
    every = [entry for statement in (*of_paper, *further) for entry in statement.entries]
    checked = [study for study in studies if registry.of(study).held_to and study.findings]
    controls = [finding for study in checked for finding in study.findings]
    body = [markup.outcome({"results": sum(not result.as_expected for result in (*every, *controls))},
                           {"results": len(every) + len(controls)})]
    for heading, group in (("Statements of the paper", of_paper), ("Further findings", further)):
        if group:
            rows = "".join(_row(statement, drawings) for statement in group)
            body.append(f"<section>\n<h2>{heading}</h2>\n{markup.table(COLUMNS, rows, heading)}</section>\n")
    if checked:
        body.append(f"<section>\n<h2>What the measurement itself is held to</h2>\n{''.join(map(_held_to, checked))}"
                    "</section>\n")
    if every:
        body.append('<section>\n<h2>Every finding</h2>\n')
        body += [_every(statement) for statement in (*of_paper, *further)]
        body.append("</section>\n")
    links = [("index.html", "all studies")]
    links += [(f"#{_anchor(statement)}", statement.name) for statement in of_paper]
    return markup.document(TITLE, ABOUT, links, "".join(body))


def statements(studies):
    """(statements of the paper, further statements); what examines the measurement itself is no evidence for either."""
    return ledger.statements(entry for study in studies if not registry.of(study).held_to
                             for entry in registry.entries(study))


def _held_to(study):
    return f'<p><a href="index.html#{study.name}">{escape(study.title)}</a>: {registry.of(study).held_to(study)}</p>\n'


def _row(statement, drawings):
    worst = statement.worst
    subjects = len({entry.subject for entry in statement.tested})
    checks = len({entry.check for entry in statement.tested})
    counts = [markup.several(len(statement.tested), "finding"), markup.several(subjects, "subject"), markup.several(checks, "condition")]
    measured = ", ".join(counts) if statement.tested else ""
    if statement.controls:
        caught = sum(entry.as_expected for entry in statement.controls)
        measured += (f'<br><span class="note">negative controls: {caught} of {len(statement.controls)} fail or '
                     "settle as they must</span>")
    verdict = markup.badge(worst, worst.control)
    if statement.unsharp:
        measured += (f'<br><span class="note">{markup.several(len(statement.unsharp), "finding")} more: a bound is not '
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
            f'<span class="note">{markup.several(len(statement.entries), "finding")}</span></summary>\n'
            f"{notes}{tables.entry_table(statement.entries, statement.name)}</details>\n")


def _anchor(statement):
    return "claim-" + "".join(c if c.isalnum() else "-" for c in statement.name).strip("-")
