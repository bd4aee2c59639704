"""Curves over run times, with bars for their spread."""

import math

import numpy as np

from drawing import axes, hover

BARS = dict(elinewidth=0.9, capsize=2, capthick=0.9)


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
