"""The figures of studies without time stepping: consistency, identities, stability."""

import math
import textwrap

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes
from drawing.look import (COLORS, DASHES, DEPARTING, GRAY, LEGEND, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, slug,
                  typography)
from reading import names

LEFT, RIGHT, GAP = 0.78, 0.1, 0.16     # inches


# ------------------------------------------------------------------------------------------------------- consistency

def consistency_drawings(study):
    """A figure per statement: a column per arrangement of the particles, a row per quantity and path or sweep."""
    drawings = []
    for statement in dict.fromkeys(finding.statement for finding in study.findings):
        found = [finding for finding in study.findings
                 if finding.statement == statement and _curve(finding) is not None]
        if found:
            drawings.append(Drawing(
                f"{study.name}.{slug(statement)}", f"{study.title}: {statement}", curves_figure(found),
                f"Log-log plots for {statement}: {found[0].claim}. A panel per arrangement of particles and path. "
                "Values: table below.",
                f"{statement}. Thin lines: theory's slope, or, dashed, the bound of each scheme where one is claimed. "
                "Schemes that agree are drawn within one another. Negative controls are drawn pale.", (statement,)))
    return drawings


def curves_figure(found, one_bound=False):
    """A panel per row and column of findings. `one_bound`: all have the same, and it is drawn once."""
    with typography():
        rows = list(dict.fromkeys(map(_row, found)))
        columns = list(dict.fromkeys(map(arrangement, found)))
        styles = subject_styles(found)
        tall = 1.9 if len(rows) <= 3 else 1.5
        width = min(4.0, (WIDTH - LEFT - RIGHT - (len(columns) - 1) * GAP) / len(columns))
        heads = [textwrap.fill(names.literal(f"{quantity}; {rest}" if rest else quantity), 120)
                 for quantity, rest, _ in rows]
        above, below, foot = 0.35, 0.5, 0.15 + legend_height(styles)
        spaces = [0.1 + 0.16 * (head.count("\n") + 1) for head in heads]
        figure = blank(above + sum(spaces) + len(rows) * (tall + below) + foot)
        top = figure.get_figheight() - above
        for row, head, space in zip(rows, heads, spaces):
            top -= space + tall
            group = [[finding for finding in found if (_row(finding), arrangement(finding)) == (row, column)]
                     for column in columns]
            curves = [[_curve(finding) for finding in cell] for cell in group]
            orders = [sorted({finding.theory_order for finding in cell if finding.test != "bounds"
                              and finding.theory_order > 0}) for cell in group]
            bounds, lines = axes.error_bounds(
                [(cell + _bounds(of), order) for cell, of, order in zip(curves, group, orders) if cell], (width, tall))
            limits = axes.x_limits([curve for cell in curves for curve in cell])
            lines = iter(lines)
            first = True
            for i, (column, cell) in enumerate(zip(columns, group)):
                if not cell:
                    continue
                panel = add_axes(figure, LEFT + i * (width + GAP), top, width, tall, xscale="log", yscale="log")
                for finding in cell:
                    style = styles[finding.subject]
                    x, y, _ = _curve(finding)
                    panel.plot(x, y, **style, alpha=0.35 if finding.control else 1.0)
                    if not finding.as_expected:
                        panel.plot(x, y, color=DEPARTING, linewidth=4, alpha=0.35, zorder=1)
                if one_bound:
                    x, y, _ = _bounds(cell)[0]
                    panel.plot(x, y, color=GRAY, linewidth=0.9, linestyle=(0, (5, 3)))
                    panel.annotate("bound", (x[0], y[0]), xytext=(0, 3), textcoords="offset points", color=GRAY,
                                   fontsize=10)
                for (x, y, _), finding in zip(_bounds([] if one_bound else cell), filter(_bounded, cell)):
                    # In turn, so that bounds that agree show all of their colors.
                    turn = list(styles).index(finding.subject)
                    panel.plot(x, y, color=styles[finding.subject]["color"], linewidth=0.9,
                               linestyle=(2.5 * turn, (2.5, 2.5 * max(1, len(styles) - 1))))
                axes.set_log_limits(panel, limits, bounds, (width, tall))
                panel.minorticks_off()      # they would take half of the drawing time
                axes.draw_references(panel, next(lines), (width, tall), GRAY)
                panel.tick_params(which="both", top=True, right=True, labelleft=first)
                panel.set_xlabel(variable_math(cell[0].variable), labelpad=1)
                if first:
                    panel.annotate(head, (0, 1), xycoords="axes fraction", xytext=(0, 5), textcoords="offset points",
                                   ha="left", va="bottom", fontsize=10, color="black")
                if row == rows[0]:
                    panel.annotate(column, (0.5, 1), xycoords="axes fraction", xytext=(0, 12 + 72 * (space - 0.1)),
                                   textcoords="offset points", ha="center", va="bottom", fontsize=12)
                first = False
            top -= below
        subject_legend(figure, styles)
        return figure


def arrangement(finding):
    return finding.check.partition(", ")[0]


def _row(finding):
    return finding.quantity, finding.check.partition(", ")[2], finding.test == "bounds"


def _bounded(finding):
    return finding.test == "bounds" and np.all(np.isfinite(finding.points.upper)) and np.all(finding.points.upper > 0)


def _bounds(found):
    return [(finding.points.variable, finding.points.upper, None) for finding in found if _bounded(finding)]


def drawable(finding):
    """Whether any of its points can be drawn on logarithmic axes."""
    return _curve(finding) is not None


def _curve(finding):
    """(x, y, None), ascending in x, NaN where it cannot be drawn; None if nothing can."""
    x, y = finding.points.variable, finding.points.value
    drawable = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    if not drawable.any():
        return None
    order = np.argsort(x, kind="stable")
    return np.where(drawable, x, np.nan)[order], np.where(drawable, y, np.nan)[order], None


# -------------------------------------------------------------------------------------------------------- identities

def identity_drawings(study):
    """Every bounded value relative to its bound, and every order as a curve."""
    bounded = [finding for finding in study.findings if _relative(finding) is not None]
    drawings = []
    if bounded:
        drawings.append(Drawing(
            study.name, study.title, dots_figure(bounded),
            f"Dot plot of {study.title}: the largest value of every finding relative to its bound. "
            "Values: table below.",
            "A dot per finding: the largest |value| relative to its bound, over all its particles and horizons; "
            "between two bounds, the distance to their middle. At the right edge: 1000 times the bound or more. A "
            "negative control (open) belongs to the right of the line, all others to the left. Right: the largest "
            "|value| of the row."))
    curves = [finding for finding in study.findings if finding.test != "bounds" and _curve(finding) is not None]
    if curves:
        drawings.append(Drawing(
            f"{study.name}.orders", f"{study.title}: orders", curves_figure(curves),
            f"Log-log plots of the values of {study.title} that must vanish with an order. Values: table below.",
            "Values that must vanish with an order; thin lines: theory's slope.",
            tuple(dict.fromkeys(finding.statement for finding in curves))))
    return drawings


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
        figure.legend(keys, arrangements, loc="lower left", ncol=6, columnspacing=1.6,
                      bbox_to_anchor=(left / WIDTH, 0.1 / figure.get_figheight()), **{**LEGEND, "handlelength": 1.2})
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


# --------------------------------------------------------------------------------------------------------- stability

def stability_drawings(study):
    found = [finding for finding in study.findings if _bounded(finding)]
    if not found:
        return []
    return [Drawing(
        study.name, study.title, growth_figure(found),
        f"Growth of the max norm in a step relative to its bound, against delta/h, for {study.title}. "
        "Values: table below.",
        "Norm of a step less 1, relative to what the lemma allows: 1 is the bound, 0 no growth at all; above 1 the "
        "scale is logarithmic. Worst of all particle numbers. Dashed and pale: negative controls, which must exceed "
        "the bound.")]


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
        high = max(2.0, values.max(initial=1.0))
        low = min(-0.1, max(-10.0, values.min(initial=0.0)))
        for i, row in enumerate(rows):
            bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
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
                    panel.plot(*curves[id(finding)], **style)
                    if not finding.as_expected:
                        panel.plot(*curves[id(finding)], color=DEPARTING, linewidth=4, alpha=0.35, zorder=1)
                panel.tick_params(which="both", top=True, right=True, labelleft=j == 0, labelbottom=(i, j) in lowest)
                if (i, j) in lowest:
                    panel.set_xlabel(variable_math(found[0].variable))
                if row == next(one.statement for one in found if arrangement(one) == column):
                    panel.annotate(column, (0.5, 1), xycoords="axes fraction", xytext=(0, 20),
                                   textcoords="offset points", ha="center", va="bottom", fontsize=12)
                if j == 0:
                    panel.set_ylabel("growth / bound")
                    panel.annotate(names.literal(row), (0, 1), xycoords="axes fraction", xytext=(0, 5),
                                   textcoords="offset points", va="bottom", fontsize=11)
        subject_legend(figure, styles)
        return figure


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


# ------------------------------------------------------------------------------------------------------------ shared

def subject_styles(found):
    """{subject: how its curves look}; open markers for the nonlocal divergence, as in every figure.

    Each is smaller than the one below it: curves of schemes that agree lie within one another.
    """
    subjects = list(dict.fromkeys(finding.subject for finding in found))
    styles = {}
    for i, subject in enumerate(subjects):
        color, above = COLORS[i % len(COLORS)], 1 - i / max(1, len(subjects) - 1)
        styles[subject] = dict(color=color, marker=MARKERS[i % len(MARKERS)], linewidth=1.0 + 1.0 * above,
                               linestyle=DASHES[i % len(DASHES)], markersize=3.4 + 3.6 * above, markeredgewidth=0.9,
                               markerfacecolor="none" if "nonlocal" in subject else color)
    return styles


def legend_columns(styles):
    return 2 if max(map(len, styles)) > 38 else 3


def legend_height(styles):
    return math.ceil(len(styles) / legend_columns(styles)) * LINE * 1.5 + 0.1


def subject_legend(figure, styles):
    figure.legend([Line2D([], [], **style) for style in styles.values()], map(names.literal, styles), loc="lower left",
                  bbox_to_anchor=(LEFT / WIDTH, 0.1 / figure.get_figheight()), ncol=legend_columns(styles),
                  columnspacing=2.0, **LEGEND)


def variable_math(name):
    formulas = {"delta": r"$\delta$", "delta/h": r"$\delta/h$", "h/delta": r"$h/\delta$"}
    return formulas.get(name) or names.variable_math(name)
