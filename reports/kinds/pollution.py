"""What the error of a series is made of: space, time, and what must be negligible."""

import math

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from drawing.look import COLORS, DEPARTING, GRAY, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from kinds.kind import Kind
from reading import names

BARS = {"space": COLORS[0], "time": COLORS[5]}
SMALLEST = 1e-16
MARKED = "/////"        # hatch of a time share of more than half
ROW, HEAD = 0.235, 0.27     # inches


def drawings(study, styles):
    found = [finding for finding in study.findings if finding.points.label]
    if not found:
        return []
    return [Drawing(
        study.name, study.title, shares_figure(found),
        f"Bars of the parts of space and time in the error of every series of {study.title}, and dots of the parts "
        "that must be negligible. Values: table below.",
        "Largest difference of the fields without one source of error, relative to the max-norm error at the finest "
        "level. Parts of the two bars may cancel or lie at different places, so they need not add up to 1. Hatched: "
        "time makes more than half of the error; the observed order is not that of space alone. Right: "
        "what must stay left of the line.", says=_says(found))]


def _says(found):
    """Where time makes more than half of the error, and the largest part that must be negligible."""
    timely = sum(_shares(finding).get("time", 0.0) > 0.5 for finding in found)
    small = [(value, label) for finding in found for label, value in _shares(finding).items()
             if label not in BARS and math.isfinite(value)]
    said = f"Time makes more than half of the error in {timely} of {len(found)} series"
    if small:
        value, label = max(small)
        said += f"; of what must be negligible the largest part is {100 * value:.2g} % ({label})"
    return f"{said}."


def shares_figure(found):
    """A row per series, grouped by study: bars of space and time, dots of everything that has a bound."""
    with typography():
        groups = {}
        for finding in found:
            groups.setdefault(finding.coordinates["study"], []).append(finding)
        dots = list(dict.fromkeys(label for finding in found for label in finding.points.label if label not in BARS))
        longest = max(len(finding.subject) for finding in found)
        left, between, foot, above = min(4.0, 0.25 + 0.062 * longest), 0.25, 0.85, 0.12
        height = len(found) * ROW + len(groups) * HEAD
        bars_width = 0.45 * (WIDTH - left - between - 0.2)
        figure = blank(above + height + foot)
        bars = add_axes(figure, left, foot, bars_width, height)
        small = add_axes(figure, left + bars_width + between, foot, WIDTH - left - between - 0.2 - bars_width, height,
                         xscale="log")
        shares = [value for finding in found for label, value in _shares(finding).items()
                  if label in BARS and math.isfinite(value)]
        bars.set(xlim=(0, max(1.05, 1.05 * max(shares, default=1.0))), ylim=(height, 0), yticks=[])
        values = [value for finding in found for label, value in _shares(finding).items()
                  if label in dots and math.isfinite(value) and value > 0]
        low = max(SMALLEST, min(values, default=1e-3)) / 3
        small.set(xlim=(low, max(0.1, 2 * max(values, default=0.01))), ylim=(height, 0), yticks=[])
        small.minorticks_off()
        y = 0.0
        for study, group in groups.items():
            for panel in (bars, small):
                panel.axhline(y, color="#D8DEE4", linewidth=0.7)
            bars.annotate(names.literal(study), (0, y + HEAD / 2), xytext=(-72 * left + 8, 0), va="center",
                          textcoords="offset points", fontsize=10, annotation_clip=False)
            y += HEAD
            for finding in group:
                _row(bars, small, finding, y, dots)
                y += ROW
        bars.axvline(0.5, color=GRAY, linewidth=0.9, linestyle=(0, (4, 2)))
        for limit in {upper for finding in found for upper in finding.points.upper if math.isfinite(upper)}:
            small.axvline(limit, color="black", linewidth=1.0)
        bars.set_xlabel("part / error", labelpad=2)
        small.set_xlabel("part / error", labelpad=2)
        keys = {label: Patch(facecolor=color) for label, color in BARS.items()}
        if any(_shares(finding).get("time", 0.0) > 0.5 for finding in found):
            keys["time > half"] = Patch(facecolor=BARS["time"], hatch=MARKED, edgecolor="black", linewidth=0)
        keys |= {label: Line2D([], [], linestyle="none", marker=MARKERS[i % len(MARKERS)], color=_color(i))
                 for i, label in enumerate(dots)}
        foot_legend(figure, 1.0, keys.values(), map(names.literal, keys), len(keys), spacing=1.5, bottom=0.12,
                    handlelength=1.3)
        return figure


def _row(bars, small, finding, y, dots):
    shares = _shares(finding)
    color = "black" if finding.as_expected else DEPARTING
    bars.annotate(names.literal(finding.subject), (0, y + ROW / 2), xytext=(-6, 0), ha="right", va="center",
                  textcoords="offset points", fontsize=9, color=color, annotation_clip=False)
    thick = 0.38 * ROW
    for i, (label, shade) in enumerate(BARS.items()):
        value = shares.get(label, math.nan)
        if math.isfinite(value):
            bars.barh(y + 0.1 * ROW + (i + 0.5) * thick, value, height=thick, facecolor=shade, edgecolor="black",
                      linewidth=0, hatch=MARKED if label == "time" and value > 0.5 else None)
    small.axhline(y + ROW / 2, color="#EDF0F3", linewidth=0.6, zorder=0)
    low, high = small.get_xlim()
    for i, label in enumerate(dots):
        value = shares.get(label)
        if value is not None:
            place = high if math.isnan(value) else min(max(value, low), high)
            small.plot(place, y + ROW / 2, linestyle="none", marker=MARKERS[i % len(MARKERS)], markersize=4.5,
                       color=_color(i), clip_on=False)


def _shares(finding):
    return dict(zip(finding.points.label, map(float, finding.points.value)))


def _color(i):
    return COLORS[(i + 1) % 5]


KIND = Kind(drawings)
