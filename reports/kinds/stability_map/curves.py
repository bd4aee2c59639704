"""Where steps are stable, as curves: sharp limits over the horizon, growth in time, the smallest entry of a step."""

import math
import textwrap

from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
import numpy as np

from drawing import axes
from drawing.look import COLORS, DASHES, DEPARTING, GRAY, LEGEND, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, typography
from reading import names
from kinds.operators import legend_columns, subject_styles
from kinds.stability_map.findings import (CAPPED, NORM, SEARCH_END, integrator_of, lemma, of_kind, ordered, parts, subject_of)

COLUMNS = 4             # panels beside one another


def drawings(study):
    return [*_limits(study), *_growth(study), *_positivity(study)]


# -------------------------------------------------------------------------------------------------------- sharp limits

def _limits(study):
    found = [finding for finding in of_kind(study, NORM) if np.any(finding.points.variable > 0)]
    if not found:
        return []
    return [Drawing(
        f"{study.name}.limits", f"{study.title}: sharp limits", limits_figure(found),
        "Log-log plots of the largest CFL number at which no step grows in the max norm beyond its bound against "
        "delta/h, a panel per lemma and arrangement of the particles. Values: table below.",
        "Largest CFL number, by bisection, up to which no step grows beyond φ(CΔt) in the max norm, φ the stability "
        "function of the integrator; where velocities vary, C > 0, implicit steps have to stay below its pole, a level "
        "line. Black line: the condition that the lemma prints; it does not suffice where a limit lies below it. Pale: "
        "the condition that the rows of the scheme need. Marks at the edges are of the first integrator: triangles "
        f"above, no limit up to {SEARCH_END:g}, where the search ends; crosses below, no step is stable. Integrators "
        "without any limit are left out.",
        tuple(ordered(found, lambda finding: finding.statement)))]


def limits_figure(found):
    """A row per lemma, a column per arrangement; a curve per scheme and integrator that has a limit somewhere."""
    with typography():
        limited = [one for one in found if np.any(one.points.value < SEARCH_END)]
        integrators = ordered(limited, integrator_of) or ordered(found, integrator_of)[:1]
        found = [finding for finding in found if integrator_of(finding) in integrators]
        rows, columns = ordered(found, lemma), ordered(found, lambda finding: parts(finding)[0])
        styles = subject_styles(found)
        left, right, gap, between, above, tall = 0.7, 0.1, 0.14, 0.32, 0.5, 2.5
        width = min(4.2, (WIDTH - left - right - (len(columns) - 1) * gap) / len(columns))
        keys = {names.literal(subject): Line2D([], [], **(style | {"linestyle": "solid"}))
                for subject, style in styles.items()}
        further = {integrator: Line2D([], [], color=GRAY, **_of_integrator(i))
                   for i, integrator in enumerate(integrators)}
        bounds = {"CFL number 1, printed in the lemma": Line2D([], [], **_PRINTED),
                  "sufficient, by the rows of the scheme": Line2D([], [], color=GRAY, **_PALE)}
        rows_of_keys = [(keys, legend_columns(styles)), (further, 5), (bounds, 5)]
        foot = 0.65 + sum(_key_height(*group) for group in rows_of_keys)
        figure = blank(above + len(rows) * tall + (len(rows) - 1) * between + foot)
        x_limits = axes.padded(np.concatenate([one.points.variable[one.points.variable > 0] for one in found]))
        drawn = [one.points.value[(one.points.value > 0) & (one.points.value < SEARCH_END)] for one in found]
        low, high = axes.padded(np.concatenate([*drawn, [0.8, 2.0]]), 0.1)
        # Room at the upper edge for the marks of what has no limit.
        unlimited = ordered([one for one in found if integrator_of(one) == integrators[0]
                             and np.any(one.points.value >= SEARCH_END)], subject_of)
        high *= (high / low) ** (0.05 * min(4, len(unlimited)))
        for i, row in enumerate(rows):
            bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
            for k, column in enumerate(columns):
                group = [one for one in found if (lemma(one), parts(one)[0]) == (row, column)]
                if not group:
                    continue
                panel = add_axes(figure, left + k * (width + gap), bottom, width, tall, xscale="log", yscale="log")
                panel.axhline(1.0, zorder=1, **_PRINTED)
                unlimited = ordered([one for one in group if integrator_of(one) == integrators[0]
                                     and np.any(one.points.value >= SEARCH_END)], subject_of)
                for finding in group:
                    turn = unlimited.index(finding.subject) if finding.subject in unlimited else 0
                    i_of = integrators.index(integrator_of(finding))
                    _draw_limit(panel, finding, styles[finding.subject], i_of, turn)
                axes.set_log_limits(panel, x_limits, (low, high), (width, tall))
                panel.minorticks_off()
                last = not any(lemma(one) in rows[i + 1:] and parts(one)[0] == column for one in found)
                panel.tick_params(top=True, right=True, labelleft=k == 0, labelbottom=last)
                if last:
                    panel.set_xlabel(r"$\delta/h$")
                if k == 0:
                    panel.set_ylabel("largest CFL number")
                    panel.annotate(names.literal(row), (0, 1), xycoords="axes fraction", xytext=(0, 5),
                                   textcoords="offset points", va="bottom", fontsize=11)
                if i == 0:
                    panel.annotate(column, (0.5, 1), xycoords="axes fraction", xytext=(0, 18),
                                   textcoords="offset points", ha="center", va="bottom", fontsize=12)
        _keys(figure, left, rows_of_keys)
        return figure


_PRINTED = dict(color="black", linewidth=2.2)
_PALE = dict(linewidth=5, alpha=0.25, solid_capstyle="round")


def _of_integrator(i):
    return dict(linestyle=DASHES[i % len(DASHES)], linewidth=1.5 if i == 0 else 1.0)


def _draw_limit(panel, finding, style, i, turn):
    """`i`: of the integrator, of which the first is drawn in full; `turn`: of the subject, whose edge marks have a row
    of their own."""
    x, y, lower = finding.points.variable, finding.points.value, finding.points.lower
    look = style | _of_integrator(i) | ({} if i == 0 else {"marker": ".", "markersize": 3.5})
    panel.plot(x, np.where((y > 0) & (y < SEARCH_END), y, np.nan), **look)
    if i == 0 and not finding.control:
        sufficient = np.where((lower > 0) & np.isfinite(lower), lower, np.nan)
        panel.plot(x, sufficient, color=style["color"], zorder=1, **_PALE)
    edge = dict(color=style["color"], linestyle="none", transform=panel.get_xaxis_transform(), markersize=5)
    for where, height, marker in ((y >= SEARCH_END, 0.97 - 0.045 * turn, "^"), (y == 0, 0.04, "x")):
        if i == 0 and where.any():
            panel.plot(x[where], np.full(where.sum(), height), marker=marker, **edge)
    if not finding.as_expected:
        panel.plot(x, np.where(y > 0, y, np.nan), color=DEPARTING, linewidth=4, alpha=0.35, zorder=1)


# --------------------------------------------------------------------------------------------------------- growth in t

def _growth(study):
    found = of_kind(study, "growth curve")
    if not found:
        return []
    horizon = dict.fromkeys(parts(one)[2].rpartition(", CFL ")[0].replace("delta", "δ") for one in found)
    return [Drawing(
        f"{study.name}.growth", f"{study.title}: growth in time", growth_figure(found),
        "Plots of the max norm of all steps up to t against t, a panel per scheme, a curve per integrator and CFL "
        "number. Values: the result file.",
        f"Max norm of all steps up to t on uniform starting positions, {' and '.join(filter(None, horizon))}. Pale "
        "gray: what theory allows, where it allows anything finite. Curves that leave a panel above go on.",
        tuple(ordered(found, lambda finding: finding.statement)))]


def growth_figure(found):
    with typography():
        integrators = ordered(found, integrator_of)
        cfl = ordered(found, _cfl)
        keys = {integrator: Line2D([], [], color=COLORS[i % len(COLORS)]) for i, integrator in enumerate(integrators)}
        further = {f"CFL {number}": Line2D([], [], color=GRAY, linestyle=DASHES[i % len(DASHES)])
                   for i, number in enumerate(cfl)}
        further["what theory allows"] = Line2D([], [], **_ALLOWED)
        every = np.concatenate([one.points.value[_positive(one.points.value)] for one in found])
        low, high = axes.padded(np.clip(np.concatenate([every, [1.0, 10.0]]), 1e-2, 1e8))
        x_limits = 0.0, max(one.points.variable.max() for one in found)

        def draw(panel, group):
            for t, upper in _allowed(group):
                panel.plot(t, upper, zorder=1, **_ALLOWED)
            for finding in group:
                i, k = integrators.index(integrator_of(finding)), cfl.index(_cfl(finding))
                t, value = finding.points.variable, finding.points.value
                value = np.where(_positive(value), value, np.nan)
                # Later curves are thinner, for many agree.
                panel.plot(t, value, color=COLORS[i % len(COLORS)], linestyle=DASHES[k % len(DASHES)],
                           linewidth=2.2 - 1.2 * i / max(1, len(integrators) - 1))
                if not finding.as_expected:
                    panel.plot(t, value, color=DEPARTING, linewidth=5, alpha=0.35, zorder=1)

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

        return _panels(found, prepare, draw, "$t$", "max norm of all steps to $t$", [(keys, 6), (further, 6)])


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
    return finding.check.rpartition("CFL ")[2]


def _positive(values):
    return np.isfinite(values) & (values > 0)


# ----------------------------------------------------------------------------------------------------------- positivity

def _positivity(study):
    found = [finding for finding in of_kind(study, "positivity") if np.any(np.isfinite(finding.points.value))]
    if not found:
        return []
    return [Drawing(
        f"{study.name}.positivity", f"{study.title}: positivity", positivity_figure(found),
        "Plots of the smallest entry of a step, the worst over delta/h, against the CFL number, a panel per scheme, a "
        "curve per integrator. Values: table below.",
        "Smallest entry of a step, the worst over δ/h; below zero a positive solution can turn negative. Logarithmic "
        "below −0.01. Filled: no entry may be negative at any of the horizons; half: at some of them; open: theory "
        "says nothing."
        + (" * Statement expected to fail, see the remarks of its findings." if any(map(_fails, found)) else ""),
        tuple(ordered(found, lambda finding: finding.statement)))]


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
                panel.plot(x, y, **(style | {"marker": None}))
                for share, fill in ((promised == 1, "full"), ((promised > 0) & (promised < 1), "left"),
                                    (promised == 0, "none")):
                    if share.any():
                        panel.plot(x[share], y[share], **(style | {"linestyle": "none", "fillstyle": fill,
                                                                   "markerfacecoloralt": "white"}))
                if not finding.as_expected:
                    panel.plot(x, y, color=DEPARTING, linewidth=5, alpha=0.35, zorder=1)

        def prepare(panel, inches):
            panel.set_xscale("log")
            axes.set_log_limits(panel, x_limits, (0.1, 1.0), inches)
            panel.set_yscale("symlog", linthresh=0.01, linscale=0.6)
            powers = range(-2, decades + 1)
            ticks = [-10.0 ** k for k in powers][::max(1, math.ceil(len(powers) / 6))]
            panel.set_ylim(-1.3 * 10.0 ** decades, 2 * highest)
            panel.set_yticks([0.0, *ticks], ["0", *(f"−{axes.tick_text(-tick, [-tick])}" for tick in ticks)])
            panel.minorticks_off()

        return _panels(found, prepare, draw, "CFL number", "smallest entry of a step", [(keys, 6)],
                       {finding.subject for finding in found if _fails(finding)})


def _entry_style(i):
    return dict(color=COLORS[i % len(COLORS)], marker=MARKERS[i % len(MARKERS)], linestyle=DASHES[i % len(DASHES)],
                linewidth=1.2, markersize=4.6, markeredgewidth=0.9)


# -------------------------------------------------------------------------------------------------------------- panels

def _panels(found, prepare, draw, x_label, y_label, keys, starred=frozenset()):
    """A panel per subject, at most four beside one another; `prepare(panel, inches)`, then `draw(panel, findings)`.

    `keys`: of the legend, [({label: handle}, columns)], one below another.
    """
    subjects = ordered(found, subject_of)
    across = 3 if len(subjects) in (5, 6) else min(COLUMNS, len(subjects))
    left, right, gap, tall = 0.85, 0.1, 0.14, 2.1
    width = min(4.0, (WIDTH - left - right - (across - 1) * gap) / across)
    titles = {subject: wrapped(f"{subject}\u00a0*" if subject in starred else subject, width) for subject in subjects}
    above = between = 0.2 + 0.16 * (1 + max(title.count("\n") for title in titles.values()))
    if any(n + across >= len(subjects) for n in range(across - 1, len(subjects) - 1, across)):
        between += 0.2      # for the numbers of a panel with nothing below it
    down = math.ceil(len(subjects) / across)
    foot = 0.65 + sum(_key_height(*group) for group in keys)
    figure = blank(above + down * tall + (down - 1) * between + foot)
    for n, subject in enumerate(subjects):
        i, k = divmod(n, across)
        bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
        panel = add_axes(figure, left + k * (width + gap), bottom, width, tall)
        prepare(panel, (width, tall))
        draw(panel, [finding for finding in found if finding.subject == subject])
        last = n + across >= len(subjects)
        panel.tick_params(top=True, right=True, labelleft=k == 0, labelbottom=last)
        panel.set_title(titles[subject], fontsize=11, pad=5, linespacing=1.0)
        if last:
            panel.set_xlabel(x_label)
        if k == 0:
            panel.set_ylabel(y_label)
    _keys(figure, left, keys)
    return figure


def _key_height(keys, columns):
    return math.ceil(len(keys) / columns) * LINE * 1.6


def _keys(figure, left, groups):
    """Legends [({label: handle}, columns)] one below another at the foot of the figure."""
    bottom = 0.1 + sum(_key_height(*group) for group in groups)
    for keys, columns in groups:
        bottom -= _key_height(keys, columns)
        figure.legend(keys.values(), keys.keys(), loc="lower left", ncol=columns, columnspacing=1.6,
                      bbox_to_anchor=(left / WIDTH, bottom / figure.get_figheight()), **LEGEND)


def wrapped(subject, width):
    return textwrap.fill(names.literal(subject), max(14, int(width / 0.072)), break_on_hyphens=False)
