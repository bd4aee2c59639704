"""The figure of studies of digits: what round-off leaves of weights and renormalizations over delta/h."""

from drawing.curves import curves_figure, drawable
from drawing.look import Drawing
from kinds import says
from kinds.kind import Kind


def drawings(study, styles):
    found = [finding for finding in study.findings
             if finding.variable_name == "delta/h" and drawable(finding)]
    if not found:
        return []
    return [Drawing(
        study.name, study.title, curves_figure(found, one_bound=True),
        f"Log-log plots of {study.title}: relative errors over delta/h, a panel for the weights of each model and one for "
        "N_j. Values: table below.",
        "The largest relative error against arithmetic of 50 digits, given exact gaps; dashed: its bound. Pale: the "
        "negative control, the same integrals as differences of closed forms.",
        tuple(dict.fromkeys(finding.statement for finding in found)), says=says.bounds(found))]


KIND = Kind(drawings)
