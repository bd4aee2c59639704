"""Curves over run times, with bars for their spread."""

import numpy as np

from drawing import axes

BARS = dict(elinewidth=0.9, capsize=2, capthick=0.9)


def error_over_seconds(panel, cases, color, **line):
    """The max-norm error of cases over their run time, bars from the fastest to the slowest repeat."""
    x, y = axes.drawable(cases.seconds, cases.error_linf)
    if np.all(np.isnan(x)):
        return
    spread = np.nan_to_num(np.clip([x - cases.seconds_low, cases.seconds_high - x], 0, None))
    panel.errorbar(x, y, xerr=spread, color=color, ecolor=color, **BARS, **line)
