"""Panels of one size side by side, on logarithmic axes."""

from dataclasses import dataclass
import math

from drawing.look import WIDTH, add_axes, blank


@dataclass(frozen=True)
class Frame:
    """One panel: its axes, its size (width, height) in inches and its place in the grid of panels."""
    axes: object
    inches: tuple
    left: float     # of the axes of the first column, in inches
    first: bool     # leftmost of its row
    last: bool      # nothing below it


def panel_frames(count, above, below, foot=0.0):
    """A figure with `count` panels, at most three a row; inches `above` and `below` every row and at the `foot`.

    With a foot and nothing below, they share their axes.
    """
    shared = foot and not below
    columns = count if count <= 3 else 2 if count == 4 else 3
    rows = math.ceil(count / columns)
    left, right, gap, label = 0.78, 0.1, 0.2, 0.55
    # Beside a single panel stands its legend, unless the legend is at the foot.
    width = 5.2 if count == 1 and not foot else (WIDTH - left - right - (columns - 1) * gap) / columns
    height = 3.6 if count == 1 else 2.6
    # Panels that share both axes name the lower one below the last row alone.
    row = above + height + (0.0 if shared else label + below)
    total = rows * row + (label + foot if shared else max(foot, 0.1))
    figure = blank(total)
    frames = []
    for i in range(count):
        x = left + (i % columns) * (width + gap)
        y = total - (i // columns) * row - above - height
        panel = add_axes(figure, x, y, width, height, xscale="log", yscale="log")
        panel.tick_params(which="both", top=True, right=True)
        frames.append(Frame(panel, (width, height), left, i % columns == 0, i + columns >= count))
    return figure, frames
