"""Stability: how much a step may grow, and how much it does."""

import math

import numpy as np

from drawing import axes, hover
from drawing.curves import bounded
from drawing.look import DASHES, GRAY, WIDTH, Drawing, add_axes, blank, mark_departing, typography
from drawing.subjects import (GAP, LEFT, RIGHT, arrangement, legend_height, subject_legend, subject_styles,
                              variable_math)
from kinds import says
from kinds.kind import Kind
from reading import names

BEYOND = 100.0      # times the bound: where the axis ends; marks at the edge stand for what goes on


def drawings(study, styles):
    found = [finding for finding in study.findings if bounded(finding)]
    if not found:
        return []
    return [Drawing(
        study.name, study.title, growth_figure(found),
        f"Growth of the max norm in a step relative to its bound, against delta/h, for {study.title}. "
        "Values: table below.",
        "Norm of a step less 1, relative to what the lemma allows: 1 is the bound, 0 no growth at all; above 1 the "
        f"scale is logarithmic, up to {BEYOND:g}; triangles at the edge: beyond it. Worst of all particle numbers. Dashed "
        "and pale: negative controls, which must exceed the bound.", says=says.bounds(found))]


def growth_figure(found):
    """A row per statement, a column per arrangement: (norm - 1) / (bound - 1) against delta/h."""
    with typography():
        rows = list(dict.fromkeys(finding.statement for finding in found))
        columns = list(dict.fromkeys(map(arrangement, found)))
        styles = subject_styles(found)
        width, tall = (WIDTH - LEFT - RIGHT - (len(columns) - 1) * GAP) / len(columns), 2.2
        above, between, foot = 0.55, 0.42, 0.62 + legend_height(styles)
        figure = blank(above + len(rows) * tall + (len(rows) - 1) * between + foot)
        curves = {id(finding): _growth(finding) for finding in found}
        values = np.concatenate([y[np.isfinite(y)] for _, y in curves.values()])
        x_all = np.concatenate([x for x, _ in curves.values()])
        drawn = {(rows.index(finding.statement), columns.index(arrangement(finding))) for finding in found}
        lowest = {(max(i for i, k in drawn if k == j), j) for j in range(len(columns))}
        low = min(-0.1, max(-10.0, values.min(initial=0.0)))
        for i, row in enumerate(rows):
            bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
            grown = np.concatenate([curves[id(one)][1] for one in found if one.statement == row])
            high = min(BEYOND, max(2.0, np.max(grown[np.isfinite(grown)], initial=1.0)))
            for j, column in enumerate(columns):
                group = [one for one in found if (one.statement, arrangement(one)) == (row, column)]
                if not group:
                    continue
                panel = add_axes(figure, LEFT + j * (width + GAP), bottom, width, tall, xscale="log")
                axes.set_log_limits(panel, axes.padded(x_all), (0.1, 1.0), (width, tall))
                panel.set_yscale("symlog", linthresh=1.0, linscale=max(0.8, 0.3 * math.log10(high)))
                panel.set_ylim(low * 1.2, high * 1.5)
                decades = range(0, math.ceil(math.log10(high)) + 1, max(1, math.ceil(math.log10(high) / 4)))
                panel.set_yticks([0.0, *(10.0 ** k for k in decades)],
                                 ["0", *("1" if k == 0 else f"$10^{{{k}}}$" for k in decades)])
                panel.minorticks_off()
                panel.axhline(1.0, color="black", linewidth=1.0)
                for finding in group:
                    style = dict(styles[finding.subject])
                    if finding.control:
                        style.update(linestyle=DASHES[1], alpha=0.4)
                    x, y = curves[id(finding)]
                    curve, = panel.plot(x, y, **style)
                    hover.mark(curve, finding.subject, f"{finding.check}: {finding.verdict}",
                               **{"δ/h": x, "growth / bound": y})
                    _leaves_above(panel, x, y, high, style)
                    if not finding.as_expected:
                        mark_departing(panel, x, y)
                panel.tick_params(which="both", top=True, right=True, labelleft=j == 0, labelbottom=(i, j) in lowest)
                if (i, j) in lowest:
                    panel.set_xlabel(variable_math(found[0].variable_name))
                if row == next(one.statement for one in found if arrangement(one) == column):
                    panel.annotate(column, (0.5, 1), xycoords="axes fraction", xytext=(0, 20),
                                   textcoords="offset points", ha="center", va="bottom", fontsize=12)
                if j == 0:
                    panel.set_ylabel("growth / bound")
                    panel.annotate(names.literal(row), (0, 1), xycoords="axes fraction", xytext=(0, 5),
                                   textcoords="offset points", va="bottom", fontsize=11)
        subject_legend(figure, styles)
        return figure


def _leaves_above(panel, x, y, high, style):
    """Marks at the upper edge for what lies beyond it, and how far it goes."""
    beyond = y > 1.4 * high
    if beyond.any():
        panel.plot(x[beyond], np.full(beyond.sum(), 0.955), linestyle="none", marker="^", markersize=4.5,
                   color=style["color"], transform=panel.get_xaxis_transform(), alpha=style.get("alpha"))
        panel.annotate(f"up to {axes.tick_text(10.0 ** round(math.log10(y[beyond].max())), [1e-9])}", (0.03, 0.9),
                       xycoords="axes fraction", va="top", fontsize=9, color=GRAY)


def _growth(finding):
    """(delta/h ascending, largest (norm - 1) / (bound - 1) there)."""
    points = finding.points
    worst = {}
    for x, value, upper in zip(points.variable, points.value, points.upper):
        ratio = (value - 1) / (upper - 1) if upper > 1 and math.isfinite(value) else math.nan
        place = float(f"{x:.6g}")
        if not worst.get(place, -math.inf) >= ratio:
            worst[place] = ratio
    return np.array(sorted(worst)), np.array([worst[x] for x in sorted(worst)])


KIND = Kind(drawings, disputes=True)
