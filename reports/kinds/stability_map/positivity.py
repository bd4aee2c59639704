"""Positivity: the smallest entry of a step over the CFL number."""

from functools import partial
import math

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes, hover
from drawing.look import DASHES, GRAY, MARKERS, Drawing, mark_departing, typography
from kinds import says
from kinds.stability_map.findings import integrator_of, of_kind, ordered
from kinds.stability_map.panels import SHADES, panels


def drawings(study):
    found = [finding for finding in of_kind(study, "positivity") if np.any(np.isfinite(finding.points.value))]
    if not found:
        return []
    return [Drawing(
        f"{study.name}.positivity", f"{study.title}: positivity", partial(positivity_figure, found),
        "Plots of the smallest entry of a step, the worst over delta/h, against the CFL number, a panel per scheme, a "
        "curve per integrator. Values: table below.",
        "Smallest entry of a step, the worst over δ/h; below zero a positive solution can turn negative. Logarithmic "
        "below −0.01. Filled: no entry may be negative at any of the horizons; half: at some of them; open: theory "
        "says nothing."
        + (" * Statement expected to fail, see the remarks of its findings." if any(map(_fails, found)) else ""),
        tuple(ordered(found, lambda finding: finding.statement)), says=f"{says.verdicts(found)}.")]


def _fails(finding):
    return finding.expected == "violated"


def worst_entries(finding):
    """(CFL number ascending, smallest entry there, share of the horizons at which it must not be negative)."""
    points = finding.points
    cfl = np.array(sorted(set(points.variable[np.isfinite(points.value)])))
    at = [(points.variable == number) & np.isfinite(points.value) for number in cfl]
    return (cfl, np.array([points.value[here].min() for here in at]),
            np.array([np.isfinite(points.lower[here]).mean() for here in at]))


def positivity_figure(found):
    with typography():
        integrators = ordered(found, integrator_of)
        keys = {integrator: Line2D([], [], **_entry_style(i)) for i, integrator in enumerate(integrators)}
        curves = {id(finding): worst_entries(finding) for finding in found}
        least = min(0.0, min(y.min() for _, y, _ in curves.values()))
        highest = max(0.003, max(y.max() for _, y, _ in curves.values()))
        decades = max(0, math.ceil(math.log10(-least))) if least < 0 else 0
        x_limits = axes.padded(np.concatenate([x[x > 0] for x, _, _ in curves.values()]))

        def draw(panel, group):
            panel.axhline(0.0, color="black", linewidth=0.9, zorder=1)
            panel.axvline(1.0, color=GRAY, linewidth=0.8, linestyle=DASHES[5], zorder=1)
            for finding in group:
                style = _entry_style(integrators.index(integrator_of(finding)))
                x, y, promised = curves[id(finding)]
                curve, = panel.plot(x, y, **(style | {"marker": None}))
                name = integrator_of(finding)
                hover.mark(curve, name, f"{finding.subject}: {finding.verdict}",
                           **{"CFL number": x, "smallest entry": y, "part of the horizons with a bound": promised})
                for share, fill in ((promised == 1, "full"), ((promised > 0) & (promised < 1), "left"),
                                    (promised == 0, "none")):
                    if share.any():
                        marks, = panel.plot(x[share], y[share], **(style | {"linestyle": "none", "fillstyle": fill,
                                                                            "markerfacecoloralt": "white"}))
                        hover.mark(marks, name)
                if not finding.as_expected:
                    mark_departing(panel, x, y, 5)

        def prepare(panel, inches):
            panel.set_xscale("log")
            axes.set_log_limits(panel, x_limits, (0.1, 1.0), inches)
            panel.set_yscale("symlog", linthresh=0.01, linscale=0.6)
            powers = range(-2, decades + 1)
            ticks = [-10.0 ** k for k in powers][::max(1, math.ceil(len(powers) / 6))]
            panel.set_ylim(-1.3 * 10.0 ** decades, 2 * highest)
            panel.set_yticks([0.0, *ticks], ["0", *(f"−{axes.tick_text(-tick, [-tick])}" for tick in ticks)])
            panel.minorticks_off()

        return panels(found, prepare, draw, "CFL number", "smallest entry of a step", [(keys, 6)],
                       {finding.subject for finding in found if _fails(finding)})


def _entry_style(i):
    return dict(color=SHADES[i % len(SHADES)], marker=MARKERS[i % len(MARKERS)], linestyle=DASHES[i % len(DASHES)],
                linewidth=1.2, markersize=4.6, markeredgewidth=0.9)
