"""The table of extremes: what is to be expected at the ends of every range, what was observed, and all of it."""

from html import escape

from drawing.curves import curves_figure, drawable
from drawing.look import Drawing, slug
from drawing.subjects import arrangement, conditions
from kinds import kind, says
from reading import ledger
from writing import markup
from writing.tables import entry_table, worst_observed

COLUMNS = ("extreme", "expectation", "worst observed", "verdict", "negative controls", "as expected")
CAPTION = "Thin lines: theory's slope. Schemes that agree are drawn within one another."


def drawings(study, styles):
    """Curves for each extreme with an order in h: those of moving particles, which have more schemes, and cases that
    are on one arrangement alone each in a figure of their own."""
    found = [finding for finding in study.findings if finding.test in ("order", "rate") and not finding.control
             and finding.variable_name == "h" and drawable(finding)]
    arrangements = {}
    for finding in found:
        arrangements.setdefault((finding.statement, conditions(finding)), {})[arrangement(finding)] = None
    groups = {}
    for finding in found:
        alone = list(arrangements[finding.statement, conditions(finding)])
        moving = "divergence" in finding.subject
        part = ", moving particles" if moving else f", {alone[0]} particles" if len(alone) == 1 else ""
        groups.setdefault((finding.statement, finding.statement + part), []).append(finding)
    return [Drawing(f"{study.name}.{slug(name)}", f"{study.title}: {name}", curves_figure(group),
                    f"Log-log plots for {name}, a panel per arrangement of particles and case. Values: table below.",
                    f"{name[0].upper()}{name[1:]}. {CAPTION}", (statement,), says=says.orders(group))
            for (statement, name), group in groups.items()]


def table(study, entries):
    """A row per expectation, each extreme with a link to its findings."""
    rows = "".join(_row(study, extreme, claim, group, len(expectations) if i == 0 else 0)
                   for extreme, expectations in _extremes(entries).items()
                   for i, (claim, group) in enumerate(expectations.items()))
    return markup.table(COLUMNS, rows, study.title) if rows else ""


def every_finding(study, entries):
    """All of each extreme, folded away unless something departs."""
    return "".join(_fold(study, extreme, expectations) for extreme, expectations in _extremes(entries).items())


def _extremes(entries):
    """{extreme: {expectation: its entries}}."""
    extremes = {}
    for entry in entries:
        extremes.setdefault(entry.statement, {}).setdefault(entry.claim, []).append(entry)
    return extremes


def _row(study, extreme, claim, group, span):
    expectation = ledger.Statement(extreme, tuple(group))
    caught = sum(entry.as_expected for entry in expectation.controls)
    departing = expectation.departing
    head = (f'<th scope="rowgroup" rowspan="{span}"><a href="#{_anchor(study, extreme)}">{escape(extreme)}</a></th>'
            if span else "")
    schemes = len({entry.subject for entry in expectation.tested})
    tested = f'<br><span class="note">{len(expectation.tested)} findings on {schemes} subjects</span>' if schemes > 1 else ""
    said = f"<strong>{len(departing)} of {len(group)} not</strong>" if departing else "all"
    worst = expectation.worst
    quantity, finest = worst.finding.quantity, _finest(worst.finding)
    note = f'<br><span class="note">{escape(finest)}</span>' if finest else ""
    return (f'<tr{markup.departs_if(departing)}>{head}<td class="said">{escape(claim)}<br><span class="note">{escape(quantity)}</span>{tested}</td>'
            f'<td class="said">{worst_observed(expectation)}{note}</td>'
            f"<td>{markup.badge(worst, worst.control)}</td>"
            f"<td>{caught} of {len(expectation.controls)} fail</td><td>{said}</td></tr>\n")


def _fold(study, extreme, expectations):
    group = [entry for entries in expectations.values() for entry in entries]
    opened = " open" if any(not entry.as_expected for entry in group) else ""
    tables = "".join(f"<p>{escape(claim)}</p>\n{entry_table(entries, claim)}"
                     for claim, entries in expectations.items())
    return (f'<details id="{_anchor(study, extreme)}"{opened}><summary>{escape(extreme)} '
            f'<span class="note">{len(group)} findings</span></summary>\n{tables}</details>\n')


def _finest(finding):
    """The value at the last level, where an order is asked for: how much there is of what vanishes."""
    points = finding.points
    if finding.test not in ("order", "rate") or not len(points) or finding.control:
        return ""
    level = f"N = {points.N[-1]}" if points.N[0] != points.N[-1] else f"{finding.variable_name} = {points.variable[-1]:.2g}"
    return f"{points.value[-1]:.2g} at {level}"


def _anchor(study, extreme):
    return f"{study.name}." + "".join(c if c.isalnum() else "-" for c in extreme).strip("-")


def _section(study, drawings, entries):
    return kind.section(study, drawings, entries, above=table(study, entries), every=every_finding(study, entries))


KIND = kind.Kind(drawings, _section)
