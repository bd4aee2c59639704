"""Identities and bounds of operators: every value beside its bound."""

from functools import partial
import math

from matplotlib.lines import Line2D
import numpy as np

from drawing.curves import curves_figure, drawable
from drawing.look import COLORS, DEPARTING, GRAY, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from drawing.subjects import arrangement
from kinds import says
from kinds.kind import Kind
from reading import names


def drawings(study, styles):
    """Every bounded value relative to its bound, and every order as a curve."""
    bounded = [finding for finding in study.findings if _relative(finding) is not None]
    drawn = []
    if bounded:
        drawn.append(Drawing(
            study.name, study.title, partial(dots_figure, bounded),
            f"Dot plot of {study.title}: the largest value of every finding relative to its bound. "
            "Values: table below.",
            "A dot per finding: the largest |value| relative to its bound, over all its particles and horizons; "
            "between two bounds, the distance to their middle. At the right edge: 1000 times the bound or more. A "
            "negative control (open) belongs to the right of the line, all others to the left. Right: the largest "
            "|value| of the row.", says=says.bounds(bounded)))
    curves = [finding for finding in study.findings if finding.test != "bounds" and drawable(finding)]
    if curves:
        drawn.append(Drawing(
            f"{study.name}.orders", f"{study.title}: orders", partial(curves_figure, curves),
            f"Log-log plots of the values of {study.title} that must vanish with an order. Values: table below.",
            "Values that must vanish with an order; thin lines: theory's slope.",
            tuple(dict.fromkeys(finding.statement for finding in curves)), says=says.orders(curves)))
    return drawn


def dots_figure(found):
    """A row per statement, quantity and model; a dot per finding."""
    with typography():
        groups = {}
        for finding in found:
            groups.setdefault((finding.statement, finding.quantity, finding.subject), []).append(finding)
        arrangements = list(dict.fromkeys(map(arrangement, found)))
        floor, ceiling = -6.0, 1.0
        ratios = [ratio for ratio, _ in map(_relative, found) if ratio > 0 and math.isfinite(ratio)]
        if ratios:
            floor = max(-6.0, min(-2.0, math.floor(math.log10(min(ratios)))))
            ceiling = min(3.0, max(1.0, math.log10(max(ratios)) + 0.2))
        edge = floor - 0.12 * (ceiling - floor)
        row, head, left, right, foot, above = 0.19, 0.3, 3.1, 0.95, 0.85, 0.3
        blocks = {}
        for statement, quantity, subject in groups:
            blocks.setdefault((statement, quantity), []).append(subject)
        height = len(groups) * row + len(blocks) * head
        figure = blank(above + height + foot)
        panel = add_axes(figure, left, foot, WIDTH - left - right, height)
        panel.set(xlim=(edge - 0.15, ceiling), ylim=(height, 0), yticks=[])
        y = 0.0
        for (statement, quantity), subjects in blocks.items():
            panel.axhline(y, color="#D8DEE4", linewidth=0.7)
            panel.annotate(names.literal(f"{statement}: {quantity}"), (edge - 0.15, y + head / 2),
                           xytext=(8 - 72 * left, 0), textcoords="offset points", va="center", fontsize=10,
                           annotation_clip=False)
            y += head
            for subject in subjects:
                _dots(panel, groups[statement, quantity, subject], arrangements, y + row / 2, edge)
                panel.annotate(names.literal(subject), (edge - 0.15, y + row / 2), xytext=(-6, 0), ha="right",
                               va="center", textcoords="offset points", fontsize=9, annotation_clip=False)
                largest = max(value for _, value in map(_relative, groups[statement, quantity, subject]))
                panel.annotate(f"{largest:.2g}", (ceiling, y + row / 2), xytext=(8, 0), va="center",
                               textcoords="offset points", fontsize=9, annotation_clip=False, color=GRAY)
                y += row
        panel.axvline(0, color="black", linewidth=1.0)
        panel.annotate("bound", (0, 0), xytext=(0, 3), textcoords="offset points", ha="center", va="bottom",
                       fontsize=10)
        stride = max(1, round((ceiling - floor) / 8))
        ticks = [edge, *range(-stride * int(-floor / stride), math.floor(ceiling) + 1, stride)]
        panel.set_xticks(ticks, ["less", *(f"$10^{{{tick}}}$" for tick in ticks[1:])])
        panel.set_xlabel("largest |value| / bound")
        for side in ("left", "right", "top"):
            panel.spines[side].set_visible(False)
        keys = [Line2D([], [], linestyle="none", marker=MARKERS[i % len(MARKERS)], color=COLORS[i % len(COLORS)])
                for i in range(len(arrangements))]
        foot_legend(figure, left, keys, arrangements, 6, spacing=1.6, handlelength=1.2)
        return figure


def _dots(panel, found, arrangements, y, edge):
    panel.axhline(y, color="#EDF0F3", linewidth=0.6, zorder=0)
    for finding in found:
        ratio, _ = _relative(finding)
        i = arrangements.index(arrangement(finding))
        color = COLORS[i % len(COLORS)] if finding.as_expected else DEPARTING
        low, high = 10 ** edge, 10 ** panel.get_xlim()[1]
        panel.plot(math.log10(min(max(ratio, low), high)), y, linestyle="none",
                   marker=MARKERS[i % len(MARKERS)], markersize=4.5, color=color,
                   markerfacecolor="none" if finding.control else color, alpha=0.85, clip_on=False)


def _relative(finding):
    """(largest deviation / allowed one, deviation there) of a bounded finding; None if no point allows any.

    Between two bounds the deviation is that from their middle, else the size of the value.
    """
    points = finding.points
    if finding.test != "bounds" or not len(points):
        return None
    both = np.isfinite(points.lower) & np.isfinite(points.upper)
    middle = np.where(both, (np.where(both, points.lower, 0) + np.where(both, points.upper, 0)) / 2, 0.0)
    deviation = np.abs(points.value - middle)
    above, below = points.upper - middle, middle - points.lower
    allowed = np.where(np.isnan(points.value), np.minimum(above, below), np.where(points.value >= middle, above, below))
    usable = np.isfinite(allowed) & (allowed > 0)
    if not usable.any():
        return None
    ratio = np.where(np.isfinite(deviation), deviation, math.inf)[usable] / allowed[usable]
    i = int(np.argmax(ratio))
    return float(ratio[i]), float(deviation[usable][i])


KIND = Kind(drawings, disputes=True)
