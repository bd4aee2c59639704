"""Growth in time: the max norm of all steps up to t."""

from functools import partial
import math

from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
import numpy as np

from drawing import axes, hover
from drawing.look import DASHES, GRAY, Drawing, mark_departing, typography
from kinds import says
from kinds.stability_map.findings import CAPPED, integrator_of, of_kind, ordered
from kinds.stability_map.panels import SHADES, panels


def drawings(study):
    found = of_kind(study, "growth curve")
    if not found:
        return []
    horizon = dict.fromkeys(f'δ = {one.coordinates["delta/h"]:g}h' for one in found)
    return [Drawing(
        f"{study.name}.growth", f"{study.title}: growth in time", partial(growth_figure, found),
        "Plots of the max norm of all steps up to t against t, a panel per scheme, a curve per integrator and CFL "
        "number. Values: the result file.",
        f"Max norm of all steps up to t on uniform starting positions, {' and '.join(filter(None, horizon))}. Pale "
        "gray: what theory allows, where it allows anything finite. Curves that leave a panel above go on.",
        tuple(ordered(found, lambda finding: finding.statement)), says=f"{says.verdicts(found)}.")]


def growth_figure(found):
    with typography():
        integrators = ordered(found, integrator_of)
        cfl = ordered(found, _cfl)
        keys = {integrator: Line2D([], [], color=SHADES[i % len(SHADES)]) for i, integrator in enumerate(integrators)}
        further = {f"CFL {number}": Line2D([], [], color=GRAY, linestyle=DASHES[i % len(DASHES)])
                   for i, number in enumerate(cfl)}
        further["what theory allows"] = Line2D([], [], **_ALLOWED)
        every = np.concatenate([one.points.value[_positive(one.points.value)] for one in found])
        allowed = max((upper[np.isfinite(upper)].max() for _, upper in _allowed(found)), default=1.0)
        low, high = axes.padded(np.clip(np.concatenate([every, [1.0, 10.0]]), 1e-2, max(SHOWN, SHOWN / 30 * allowed)))
        x_limits = 0.0, max(one.points.variable.max() for one in found)

        def draw(panel, group):
            for t, upper in _allowed(group):
                panel.plot(t, upper, zorder=1, **_ALLOWED)
            for finding in group:
                i, k = integrators.index(integrator_of(finding)), cfl.index(_cfl(finding))
                t, value = finding.points.variable, finding.points.value
                value = np.where(_positive(value), value, np.nan)
                # Later curves are thinner, for many agree.
                curve, = panel.plot(t, value, color=SHADES[i % len(SHADES)], linestyle=DASHES[k % len(DASHES)],
                                   linewidth=2.2 - 1.2 * i / max(1, len(integrators) - 1))
                hover.mark(curve, integrator_of(finding), f"{finding.subject}, CFL {_cfl(finding)}: {finding.verdict}",
                           t=t, growth=value)
                if not finding.as_expected:
                    mark_departing(panel, t, value, 5)

        def prepare(panel, inches):
            panel.set(yscale="log", xlim=x_limits, ylim=(low, high))
            decades = range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)
            ticks = 10.0 ** np.array(decades[::max(1, math.ceil(len(decades) / 6))])
            panel.set_yticks(ticks, [axes.tick_text(tick, ticks) for tick in ticks])
            panel.minorticks_off()
            # None at the right end, where it would meet the next panel's.
            ticks = MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]).tick_values(*x_limits)
            ticks = [tick for tick in ticks if 0 <= tick < 0.95 * x_limits[1]]
            panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])

        return panels(found, prepare, draw, "$t$", "max norm of all steps to $t$", [(keys, 6), (further, 6)])


SHOWN = 1e3     # growth that a panel shows at least; the axis ends 30 times beyond what is allowed

_ALLOWED = dict(color="#C4C9CE", linewidth=3.2, solid_capstyle="butt")


def _allowed(group):
    """The finite bounds (t, bound), but none that is constant and shorter than another of the same height."""
    bounds = {}
    for finding in group:
        t, upper = finding.points.variable, finding.points.upper
        if not np.any(upper < CAPPED):
            continue
        curve = t, np.where(upper < CAPPED, upper, np.nan)
        constant = np.all(upper < CAPPED) and upper.max() < upper.min() * (1 + 1e-6)
        key = f"{upper[0]:.6g}" if constant else id(finding)
        if key not in bounds or np.ptp(t) > np.ptp(bounds[key][0]):
            bounds[key] = curve
    return bounds.values()


def _cfl(finding):
    return f'{finding.coordinates["cfl"]:g}'


def _positive(values):
    return np.isfinite(values) & (values > 0)
