"""The figures of the table of extremes: what vanishes under refinement there."""

from drawing.look import Drawing, slug
from kinds import operators

CAPTION = "Thin lines: theory's slope. Schemes that agree are drawn within one another."


def drawings(study):
    """Curves for each extreme with an order in h: those of moving particles, which have more schemes, and cases that
    are on one arrangement alone each in a figure of their own."""
    found = [finding for finding in study.findings if finding.test in ("order", "rate") and not finding.control
             and finding.variable == "h" and operators.drawable(finding)]
    arrangements = {}
    for finding in found:
        arrangement, _, case = finding.check.partition(", ")
        arrangements.setdefault((finding.statement, case), {})[arrangement] = None
    groups = {}
    for finding in found:
        alone = list(arrangements[finding.statement, finding.check.partition(", ")[2]])
        moving = "divergence" in finding.subject
        part = ", moving particles" if moving else f", {alone[0]} particles" if len(alone) == 1 else ""
        groups.setdefault((finding.statement, finding.statement + part), []).append(finding)
    return [Drawing(f"{study.name}.{slug(name)}", f"{study.title}: {name}", operators.curves_figure(group),
                    f"Log-log plots for {name}, a panel per arrangement of particles and case. Values: table below.",
                    f"{name[0].upper()}{name[1:]}. {CAPTION}", (statement,))
            for (statement, name), group in groups.items()]
