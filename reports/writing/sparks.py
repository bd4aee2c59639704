"""Small pictures of what came out, beside a verdict: drawn in the page's own colors, and hidden from who hears it."""

import math

from markupsafe import Markup

WIDTH, HEIGHT = 120, 26


def _picture(marks):
    return Markup('<svg class="spark" viewBox="0 0 {} {}" aria-hidden="true">{}</svg>').format(
        WIDTH, HEIGHT, Markup("").join(marks))


def ratios(values):
    """A stroke for each ratio of an observed order to theory's, from 0.5 to 1.5, on the line of 1."""
    marks = [Markup('<path class="axis" d="M0 {0}H{1}M{2} 2V{3}"/>').format(HEIGHT - 3, WIDTH, WIDTH / 2, HEIGHT - 1)]
    for ratio in values:
        if math.isfinite(ratio):
            x = WIDTH * min(1.0, max(0.0, ratio - 0.5))
            marks.append(Markup('<path class="tick" d="M{:.1f} 5V{}"/>').format(x, HEIGHT - 4))
    return _picture(marks)


def shares(counts):
    """A bar of parts {kind: number}; kinds are those of badges."""
    total, at, marks = sum(counts.values()), 0.0, []
    for kind, number in counts.items():
        width = WIDTH * number / total if total else 0
        # What departs is to be seen, however little it is.
        width = max(width, 3.0) if number and kind == "bad" else width
        if width:
            marks.append(Markup('<rect class="{}" x="{:.1f}" y="8" width="{:.1f}" height="10"/>').format(
                kind, min(at, WIDTH - width), width))
        at += width
    return _picture(marks)


def matrix(rows):
    """Rows of cells, true where an alarm is raised."""
    down, across = len(rows), max(map(len, rows), default=0)
    if not across:
        return ""
    x, y = WIDTH / across, HEIGHT / down
    marks = [Markup('<rect class="{}" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>').format(
        "on" if cell else "off", x * k, y * i, 0.8 * x, 0.8 * y)
        for i, row in enumerate(rows) for k, cell in enumerate(row)]
    return _picture(marks)


def front(points, efficient):
    """Points (cost, error), both logarithmic, those that are `efficient` joined."""
    usable = [(math.log(x), math.log(y), good) for (x, y), good in zip(points, efficient)
              if x > 0 and y > 0 and math.isfinite(x) and math.isfinite(y)]
    if len(usable) < 2:
        return ""
    xs, ys, _ = zip(*usable)
    wide, tall = max(xs) - min(xs) or 1.0, max(ys) - min(ys) or 1.0
    places = [(2 + (WIDTH - 4) * (x - min(xs)) / wide, HEIGHT - 2 - (HEIGHT - 4) * (y - min(ys)) / tall, good)
              for x, y, good in usable]
    dots = [Markup('<circle cx="{:.1f}" cy="{:.1f}" r="1.3"/>').format(x, y) for x, y, _ in places]
    line = "L".join(f"{x:.1f} {y:.1f}" for x, y, good in sorted(places) if good)
    return _picture([*dots, Markup('<path class="line" d="M{}"/>').format(line)])
