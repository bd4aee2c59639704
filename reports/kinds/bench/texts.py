"""Run times as texts of tables."""

import math


def seconds(value):
    """Two significant digits, which is what a run time has."""
    if not math.isfinite(value):
        return "–"
    return f"{value:.2g}" if 1e-3 <= value < 100 else f"{value:.0f}" if value >= 100 else f"{value:.1e}"
