"""Curves of findings on logarithmic axes: a column per arrangement of the particles, a row per quantity and path."""

import textwrap

import numpy as np

from drawing import axes, hover
from drawing.look import GRAY, WIDTH, add_axes, blank, mark_departing, typography
from drawing.subjects import (GAP, LEFT, RIGHT, arrangement, conditions, legend_height, subject_legend, subject_styles,
                              variable_math)
from reading import names


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
            limits = axes.x_limits([curve for cell in curves for curve in cell])
            shown = [(cell + _bounds(of), order) for cell, of, order in zip(curves, group, orders) if cell]
            bounds, lines = axes.error_bounds(shown, (width, tall), [limits] * len(shown))
            lines = iter(lines)
            first = True
            for i, (column, cell) in enumerate(zip(columns, group)):
                if not cell:
                    continue
                panel = add_axes(figure, LEFT + i * (width + GAP), top, width, tall, xscale="log", yscale="log")
                for finding in cell:
                    style = styles[finding.subject]
                    x, y, _ = _curve(finding)
                    curve, = panel.plot(x, y, **style, alpha=0.35 if finding.control else 1.0)
                    hover.mark(curve, finding.subject, f"{finding.check}: {finding.verdict}", **_said(finding))
                    if not finding.as_expected:
                        mark_departing(panel, x, y)
                if one_bound:
                    x, y, _ = _bounds(cell)[0]
                    panel.plot(x, y, color=GRAY, linewidth=0.9, linestyle=(0, (5, 3)))
                    panel.annotate("bound", (x[0], y[0]), xytext=(0, 3), textcoords="offset points", color=GRAY,
                                   fontsize=10)
                for (x, y, _), finding in zip(_bounds([] if one_bound else cell), filter(bounded, cell)):
                    # In turn, so that bounds that agree show all of their colors.
                    turn = list(styles).index(finding.subject)
                    panel.plot(x, y, color=styles[finding.subject]["color"], linewidth=0.9,
                               linestyle=(2.5 * turn, (2.5, 2.5 * max(1, len(styles) - 1))))
                axes.set_log_limits(panel, limits, bounds, (width, tall))
                axes.draw_references(panel, next(lines), (width, tall), GRAY)
                panel.tick_params(which="both", top=True, right=True, labelleft=first)
                panel.set_xlabel(variable_math(cell[0].variable_name), labelpad=1)
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


def _row(finding):
    return finding.quantity, conditions(finding), finding.test == "bounds"


def bounded(finding):
    return finding.test == "bounds" and np.all(np.isfinite(finding.points.upper)) and np.all(finding.points.upper > 0)


def _bounds(found):
    return [(finding.points.variable, finding.points.upper, None) for finding in found if bounded(finding)]


def _said(finding):
    """What is said of its points, in the order in which they are drawn."""
    points, order = finding.points, np.argsort(finding.points.variable, kind="stable")
    said = {"N": points.N, "h": points.h, "δ": points.delta, finding.quantity: points.value}
    return {name: values[order] for name, values in said.items() if np.any(values > 0)}


def drawable(finding):
    """Whether any of its points can be drawn on logarithmic axes."""
    return _curve(finding) is not None


def _curve(finding):
    """(x, y, None), ascending in x, NaN where it cannot be drawn; None if nothing can."""
    x, y = finding.points.variable, finding.points.value
    order = np.argsort(x, kind="stable")
    x, y = axes.drawable(x[order], y[order])
    return None if np.all(np.isnan(x)) else (x, y, None)
