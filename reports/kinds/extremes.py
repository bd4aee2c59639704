"""The table of extremes: what is to be expected at the ends of every range, what was observed, and all of it."""

from functools import partial

from markupsafe import Markup

from drawing.curves import curves_figure, drawable
from drawing.look import Drawing, slug
from drawing.subjects import arrangement, conditions
from kinds import kind, says
from reading import ledger
from writing import markup, tables

COLUMNS = ("~extreme", "~expectation", "~worst observed", "verdict", "negative controls", "as expected")
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
    return [Drawing(f"{study.name}.{slug(name)}", f"{study.title}: {name}", partial(curves_figure, group),
                    f"Log-log plots for {name}, a panel per arrangement of particles and case. Values: table below.",
                    f"{name[0].upper()}{name[1:]}. {CAPTION}", (statement,), says=says.orders(group))
            for (statement, name), group in groups.items()]


def table(study, entries):
    """A row per expectation, each extreme with a link to its findings."""
    rows = [_row(study, extreme, claim, group) for extreme, expectations in _extremes(entries).items()
            for claim, group in expectations.items()]
    return tables.table(study.title, COLUMNS, rows) if rows else ""


def every_finding(study, entries):
    """All of each extreme, folded away unless something departs."""
    return markup.joined(_fold(study, extreme, group) for extreme, group in _extremes(entries).items())


def _extremes(entries):
    """{extreme: {expectation: its entries}}."""
    extremes = {}
    for entry in entries:
        extremes.setdefault(entry.statement, {}).setdefault(entry.claim, []).append(entry)
    return extremes


def _row(study, extreme, claim, group):
    expectation = ledger.Statement(extreme, tuple(group))
    caught = sum(entry.as_expected for entry in expectation.controls)
    departing = expectation.departing
    schemes = len({entry.subject for entry in expectation.tested})
    worst = expectation.worst
    notes = [worst.finding.quantity, f"{len(expectation.tested)} findings on {schemes} subjects" if schemes > 1 else ""]
    claimed = markup.joined([claim, *map(markup.note, filter(None, notes))], markup.BAR)
    observed = markup.joined(filter(None, (tables.worst_observed(expectation), markup.note(_finest(worst.finding)))),
                             markup.BAR)
    said = (Markup("<strong>{} of {} not</strong>").format(len(departing), len(group)) if departing else "all")
    return tables.Row((markup.link(_anchor(study, extreme), extreme), claimed, observed,
                       markup.badge(worst, worst.control), f"{caught} of {len(expectation.controls)} fail", said),
                      bool(departing))


def _fold(study, extreme, expectations):
    group = [entry for entries in expectations.values() for entry in entries]
    opened = any(not entry.as_expected for entry in group)
    content = markup.joined(Markup("<p>{}</p>\n{}").format(claim, tables.entry_table(entries, f"{extreme}: {claim}"))
                            for claim, entries in expectations.items())
    said = Markup("{} {}").format(extreme, markup.note(f"{len(group)} findings"))
    return tables.fold(said, content, opened, _anchor(study, extreme), "findings")


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
