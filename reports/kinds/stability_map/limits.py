"""Sharp limits: the largest CFL numbers at which no step grows beyond its bound, over the horizon."""

from functools import partial

from matplotlib.lines import Line2D
from matplotlib.patches import Patch
import numpy as np

from drawing import axes, hover
from drawing.look import DASHES, GRAY, MARKERS, Drawing, mark_departing, typography
from kinds.stability_map.findings import NORM, SEARCH_END, integrator_of, of_kind, ordered, parts, subject_of
from kinds.stability_map.panels import SHADES, panels


def drawings(study):
    found = [finding for finding in of_kind(study, NORM) if np.any(finding.points.variable > 0)]
    if not found:
        return []
    arrangements = ordered(found, lambda finding: parts(finding)[0])
    return [Drawing(
        f"{study.name}.limits", f"{study.title}: sharp limits", partial(limits_figure, found),
        "Log-log plots of the largest CFL number at which no step grows in the max norm beyond its bound against "
        "delta/h, a panel per scheme, a curve per integrator. Values: table below.",
        "Largest CFL number, by bisection, up to which no step grows beyond φ(CΔt) in the max norm, φ the stability "
        "function of the integrator; where velocities vary, C > 0, implicit steps have to stay below its pole, a level "
        f"line. Lines: the least over {', '.join(arrangements)} particles; shaded: up to the largest. Thick line at 1: the "
        "condition that the lemmas print; it does not suffice where a limit lies below it. Gray: the condition that the "
        f"rows of the scheme need, of the first integrator. Marks at the edges: triangles above, no limit up to "
        f"{SEARCH_END:g}, where the search ends; crosses below, no step is stable. Integrators without any limit are "
        "left out.",
        tuple(ordered(found, lambda finding: finding.statement)), says=_says(found))]


def _says(found):
    """Where the printed condition does not suffice."""
    true = [finding for finding in found if not finding.control]
    below = [subject for subject in ordered(true, subject_of)
             if any(np.any(one.points.value < 1 - 1e-6) for one in true if one.subject == subject)]
    if not below:
        return "A CFL number of 1, as the lemmas print it, suffices for every scheme and integrator."
    least = min((one.points.value.min(), one.subject, integrator_of(one)) for one in true)
    return (f"A CFL number of 1, as the lemmas print it, does not suffice for {'; '.join(below)}: the least limit is "
            f"{least[0]:.2g} ({least[1]}, {least[2]}).")


def limits_figure(found):
    """A panel per scheme; a curve per integrator that has a limit somewhere."""
    with typography():
        limited = [one for one in found if np.any(one.points.value < SEARCH_END)]
        integrators = ordered(limited, integrator_of) or ordered(found, integrator_of)[:1]
        found = [finding for finding in found if integrator_of(finding) in integrators]
        keys = {integrator: Line2D([], [], **_look(i)) for i, integrator in enumerate(integrators)}
        further = {"CFL number 1, printed in the lemmas": Line2D([], [], **_PRINTED),
                   "sufficient, by the rows of the scheme": Line2D([], [], **_ROWS),
                   "of all arrangements": Patch(facecolor=GRAY, alpha=_BAND)}
        x_limits = axes.padded(np.concatenate([one.points.variable[one.points.variable > 0] for one in found]))
        drawn = [one.points.value[(one.points.value > 0) & (one.points.value < SEARCH_END)] for one in found]
        low, high = axes.padded(np.concatenate([*drawn, [0.8, 2.0]]), 0.1)

        def prepare(panel, inches):
            panel.set(xscale="log", yscale="log")
            axes.set_log_limits(panel, x_limits, (low, high), inches)
            panel.axhline(1.0, zorder=1, **_PRINTED)

        def draw(panel, group):
            for i, integrator in enumerate(integrators):
                _draw_limit(panel, [one for one in group if integrator_of(one) == integrator], i)

        return panels(found, prepare, draw, r"$\delta/h$", "largest CFL number", [(keys, 5), (further, 3)])


_PRINTED = dict(color="black", linewidth=2.2)
_ROWS = dict(color="#C4C9CE", linewidth=4, solid_capstyle="butt")
_BAND = 0.18


def _look(i):
    color = SHADES[i % len(SHADES)]
    return dict(color=color, marker=MARKERS[i % len(MARKERS)], linestyle=DASHES[i % len(DASHES)], linewidth=1.3,
                markersize=4.0, markerfacecolor=color if i % 2 == 0 else "none", markeredgewidth=0.9)


def _draw_limit(panel, findings, i):
    """The limits of one scheme and integrator, `i` of the figure's, over the arrangements of the particles."""
    if not findings:
        return
    x, least, largest, rows = over_arrangements(findings)
    look = _look(i)

    def shown(values):
        return np.where((values > 0) & (values < SEARCH_END), values, np.nan)

    if i == 0 and not findings[0].control:
        panel.plot(x, np.where((rows > 0) & np.isfinite(rows), rows, np.nan), zorder=1, **_ROWS)
    panel.fill_between(x, shown(least), np.minimum(largest, SEARCH_END), color=look["color"], alpha=_BAND, linewidth=0,
                       where=np.isfinite(shown(least)))
    curve, = panel.plot(x, shown(least), **look)
    hover.mark(curve, integrator_of(findings[0]), findings[0].subject,
               **{"δ/h": x, "largest CFL number": least, "on other particles up to": largest, "by the rows": rows})
    edge = dict(color=look["color"], linestyle="none", transform=panel.get_xaxis_transform(), markersize=5)
    for where, height, marker in ((least >= SEARCH_END, 0.96 - 0.05 * i, "^"), (least == 0, 0.05 + 0.05 * i, "x")):
        if where.any():
            panel.plot(x[where], np.full(where.sum(), height), marker=marker, **edge)
    if not all(finding.as_expected for finding in findings):
        mark_departing(panel, x, shown(least))


def over_arrangements(findings):
    """(delta/h ascending, least limit there, largest limit, least of what the rows need; NaN: not known)."""
    at = {}
    for finding in findings:
        for x, value, lower in zip(finding.points.variable, finding.points.value, finding.points.lower):
            at.setdefault(float(f"{x:.3g}"), []).append((value, lower))
    places = sorted(at)
    values = [np.array(at[place]) for place in places]
    return (np.array(places), *(np.array([of(value) for value in values]) for of in (
        lambda value: value[:, 0].min(), lambda value: value[:, 0].max(), lambda value: value[:, 1].min())))
