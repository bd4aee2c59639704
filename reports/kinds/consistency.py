"""Consistency: how fast truncation errors vanish."""

from functools import partial

from drawing.curves import curves_figure, drawable
from drawing.look import Drawing, slug
from kinds import says
from kinds.kind import Kind


def drawings(study, styles):
    """A figure per statement: a column per arrangement of the particles, a row per quantity and path or sweep."""
    drawn = []
    for statement in dict.fromkeys(finding.statement for finding in study.findings):
        found = [finding for finding in study.findings
                 if finding.statement == statement and drawable(finding)]
        if found:
            drawn.append(Drawing(
                f"{study.name}.{slug(statement)}", f"{study.title}: {statement}", partial(curves_figure, found),
                f"Log-log plots for {statement}: {found[0].claim}. A panel per arrangement of particles and path. "
                "Values: table below.",
                f"{statement}. Thin lines: theory's slope, or, dashed, the bound of each scheme where one is claimed. "
                "Schemes that agree are drawn within one another. Negative controls are drawn pale.", (statement,),
                says=says.orders([finding for finding in study.findings if finding.statement == statement])))
    return drawn


KIND = Kind(drawings, disputes=True)
