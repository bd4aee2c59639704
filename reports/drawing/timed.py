"""Curves over run times, with bars for their spread."""

import math

import numpy as np

from drawing import axes, hover
from drawing.look import GRAY
from reading import work_precision

BARS = dict(elinewidth=0.9, capsize=2, capthick=0.9)
EFFICIENT = dict(linestyle="none", marker="o", markersize=13, markeredgewidth=0, color="#D3D3D3", zorder=1)


def of_cases(cases):
    """What is said of each case of a series where one points at it."""
    return {"N": cases.N, "h": cases.h, "δ": cases.delta, "max-norm error": cases.error_linf,
            "order to the coarser": [math.nan, *cases.pairwise][:len(cases)], "seconds": cases.seconds}


def error_over_seconds(panel, cases, color, name, about="", **line):
    """The max-norm error of cases over their run time, bars from the fastest to the slowest repeat.

    name, about: of the series, for who points at it.
    """
    x, y = axes.drawable(cases.seconds, cases.error_linf)
    if np.all(np.isnan(x)):
        return
    spread = np.nan_to_num(np.clip([x - cases.seconds_low, cases.seconds_high - x], 0, None))
    curve = panel.errorbar(x, y, xerr=spread, color=color, ecolor=color, **BARS, **line)
    hover.mark(curve, name, about, **of_cases(cases))


def mark_frontier(panel, costs, errors, N=None):
    """Gray behind the points that no other one beats in both cost and error, and their `N` on the side that is free."""
    efficient = work_precision.frontier(costs, errors)
    panel.plot(costs[efficient], errors[efficient], **EFFICIENT)
    if N is None:
        return
    last = None
    for i in sorted(np.flatnonzero(efficient), key=lambda i: costs[i]):
        # Points close to one another would write over each other.
        if last is None or abs(np.log10(errors[last] / errors[i])) + abs(np.log10(costs[i] / costs[last])) > 0.25:
            panel.annotate(str(N[i]), (costs[i], errors[i]), xytext=(-6, -4), textcoords="offset points", ha="right",
                           va="top", fontsize=9, color=GRAY)
            last = i
