"""Logarithmic axes of a figure: limits, ticks that do not collide, names of levels, lines of a theory's slope."""

from dataclasses import dataclass
import math

from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator, NullFormatter
import numpy as np

# Inches: between the lowest curve and a reference line, for the label below one, and how far one may leave the curves.
GAP, LABEL, CUT = 0.18, 0.22, 0.6


def drawable(x, y):
    """(x, y) with NaN where a point has no place on logarithmic axes: a curve breaks there."""
    good = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    return np.where(good, x, np.nan), np.where(good, y, np.nan)


def padded(values, part=0.06):
    """Limits around positive finite values, wider by `part` of their logarithmic range; (0.1, 1) for no values."""
    if len(values) == 0:
        return 0.1, 1.0
    low, high = math.log10(min(values)), math.log10(max(values))
    # One level, or levels that agree to round-off, still need an axis on which a tick can stand.
    if high - low < 0.3:
        low, high = (low + high) / 2 - 0.15, (low + high) / 2 + 0.15
    pad = part * (high - low)
    return 10 ** (low - pad), 10 ** (high + pad)


@dataclass(frozen=True)
class Reference:
    """The line y = factor x^order between x = start and x = end."""
    order: float
    factor: float
    start: float
    end: float

    def __call__(self, x):
        return self.factor * x ** self.order

    def middle(self):
        return math.sqrt(self.start * self.end)


def references(curves, orders, x_limits, y_limits, inches):
    """A line of each slope in `orders`, below every curve (x, y, ...) and below one another."""
    points = [(x, y) for xs, ys, *_ in curves for x, y in zip(xs, ys) if math.isfinite(x) and math.isfinite(y)]
    if not points:
        return []
    low, high = min(x for x, _ in points), max(x for x, _ in points)
    if high < low * (1 + 1e-9):
        return []
    per_decade = [size / math.log10(limits[1] / limits[0]) for size, limits in zip(inches, (x_limits, y_limits))]
    lines = []
    for order in orders:
        # The gap is measured at right angles to the line, so that steep lines keep the same distance.
        lean = math.hypot(1, order * per_decade[1] / per_decade[0]) / per_decade[1]
        factor = min(y / x ** order for x, y in points) / 10 ** (GAP * lean)
        # A curve that stagnates would drag a long line far below the panel: cut the line there.
        start, floor = low, y_limits[0] / 10 ** (CUT / per_decade[1])
        if order > 0:
            start = min(max(low, (floor / factor) ** (1 / order)), high / (high / low) ** 0.2)
        lines.append(Reference(order, factor, start, high))
        # The next line keeps clear of this one and of its label.
        points += [(x, lines[-1](x) / 10 ** (LABEL * lean)) for x in (start, high)]
    return lines


def error_bounds(panels, inches, limits=None):
    """Limits (low, high) of the error for panels [(curves, orders)], and the reference lines of every panel.

    limits: of the theory's variable, a pair per panel; those of its curves where none are given.
    """
    limits = limits or [x_limits(curves) for curves, _ in panels]
    errors = np.concatenate([y[np.isfinite(y)] for curves, _ in panels for _, y, *_ in curves])
    low, high = bare = padded(errors)
    per_decade = inches[1] / math.log10(high / low)
    lines = [references(curves, orders, span, bare, inches) for (curves, orders), span in zip(panels, limits)]
    for line in (line for group in lines for line in group):
        low = min(low, line(line.start) / 10 ** (0.12 / per_decade),
                  line(line.middle()) / 10 ** ((LABEL + 0.1) / per_decade))
    return (low, high), lines


def x_limits(curves):
    """Limits of the theory's variable for curves (x, y, ...)."""
    return padded(np.concatenate([x[np.isfinite(x)] for x, *_ in curves]), 0.09)


def equal_spans(limits):
    """The limits (low, high), widened on both sides until all span as many decades as the widest: slopes compare."""
    widest = max(high / low for low, high in limits)
    return [tuple(math.sqrt(low * high) * widest ** half for half in (-0.5, 0.5)) for low, high in limits]


def set_log_limits(panel, x_limits, y_limits, inches):
    """Limits and ticks of both axes; `inches` is the panel's size, on which the number of labels depends."""
    panel.set_xlim(x_limits)
    panel.set_ylim(y_limits)
    _set_ticks(panel.xaxis, x_limits, max(2, int(inches[0] / 0.48)))
    _set_ticks(panel.yaxis, y_limits, max(2, int(inches[1] / 0.32)))


def _set_ticks(axis, limits, most):
    ticks = _ticks(*limits, most)
    low, high = math.floor(math.log10(limits[0])), math.ceil(math.log10(limits[1]))
    few = high - low < 8
    minor = [m * 10.0 ** k for k in range(low, high + 1) for m in range(2, 10)] if few else []
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(FixedFormatter([tick_text(tick, ticks) for tick in ticks]))
    axis.set_minor_locator(FixedLocator([tick for tick in minor if limits[0] <= tick <= limits[1]]))
    axis.set_minor_formatter(NullFormatter())


def _ticks(low, high, most):
    """The fewest round ticks that are three or more, at most `most` of them."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    stride = max(1, math.ceil((len(decades) - 2) / most))
    best = []
    for steps in ((1,), (1, 3), (1, 2, 5), (1, 2, 3, 5, 7), (1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)):
        chosen = decades[::stride] if steps == (1,) else decades
        ticks = [float(f"{step}e{k}") for k in chosen for step in steps]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) > most:
            break
        best = ticks
        if len(ticks) >= 3:
            break
    if len(best) < 2:
        best = [tick for tick in MaxNLocator(min(most, 4)).tick_values(low, high) if low <= tick <= high]
    return best


def tick_text(tick, ticks):
    if min(ticks) >= 1e-4 and max(ticks) < 1e5:
        return f"{tick:.6g}"
    power = math.floor(math.log10(tick) + 1e-9)
    factor = tick / 10.0 ** power
    return f"$10^{{{power}}}$" if abs(factor - 1) < 1e-6 else rf"${factor:.3g}{{\times}}10^{{{power}}}$"


def name_levels(panel, levels, width, lead):
    """N above the panel, at the place of each level (x, N); nothing if two series mean different N by the same x.

    `lead`: say in front of the numbers that they are N.
    """
    found = {}
    for x, N in levels:
        for place, number in zip(x, N):
            if math.isfinite(place) and place > 0 and found.setdefault(float(f"{place:.9g}"), int(number)) != number:
                return
    low, high = panel.get_xlim()
    style = dict(xycoords=panel.get_xaxis_transform(), textcoords="offset points", va="bottom", fontsize=9.5,
                 color="#595959")
    free = math.inf     # inches from the left edge up to which nothing is written yet
    for place in sorted(found, reverse=True):
        at = width * math.log(place / low) / math.log(high / low)
        half = (0.075 * len(str(found[place])) + 0.1) / 2
        if at + half <= free:
            panel.annotate(str(found[place]), (place, 1), xytext=(0, 4), ha="center", **style)
            free = at - half
    if lead and math.isfinite(free):
        panel.annotate("$N=$", (low, 1), xytext=(72 * free, 4), ha="right", **style)


def draw_references(panel, lines, inches, color):
    """Thin lines of the theory's slopes, each with its order written along it, on the side away from the curves."""
    (left, right), (bottom, top) = panel.get_xlim(), panel.get_ylim()
    square = inches[1] / math.log10(top / bottom) / (inches[0] / math.log10(right / left))
    for line in lines:
        panel.plot((line.start, line.end), (line(line.start), line(line.end)), color=color, linewidth=0.8,
                   linestyle="solid", zorder=2)
        angle = math.atan(line.order * square)
        panel.annotate(f"order {line.order:g}", (line.middle(), line(line.middle())), textcoords="offset points",
                       xytext=(3 * math.sin(angle), -3 * math.cos(angle)), rotation=math.degrees(angle),
                       rotation_mode="anchor", ha="center", va="top", fontsize=10, color=color)
