"""Sharp limits: the largest CFL numbers at which no step grows beyond its bound, over the horizon."""

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes
from drawing.look import DASHES, GRAY, WIDTH, Drawing, add_axes, blank, mark_departing, typography
from drawing.subjects import legend_columns, subject_styles
from kinds.stability_map.findings import NORM, SEARCH_END, integrator_of, lemma, of_kind, ordered, parts, subject_of
from kinds.stability_map.panels import key_height, stacked_legends
from reading import names


def drawings(study):
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
        foot = 0.65 + sum(key_height(*group) for group in rows_of_keys)
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
        stacked_legends(figure, left, rows_of_keys)
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
        mark_departing(panel, x, np.where(y > 0, y, np.nan))
