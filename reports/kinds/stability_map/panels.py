"""A panel per subject, and legends one below another at the foot."""

import math
import textwrap

from drawing import hover
from drawing.look import COLORS, LINE, WIDTH, add_axes, blank, foot_legend
from kinds.stability_map.findings import ordered, subject_of
from reading import names

COLUMNS = 4             # panels beside one another
# Of integrators, in every figure of a map; black is for what theory says.
SHADES = (*COLORS[:4], *COLORS[5:])


def panels(found, prepare, draw, x_label, y_label, keys, starred=frozenset()):
    """A panel per subject, at most four beside one another; `prepare(panel, inches)`, then `draw(panel, findings)`.

    `keys`: of the legend, [({label: handle}, columns)], one below another; the first ones are of series.
    """
    subjects = ordered(found, subject_of)
    across = 3 if len(subjects) in (5, 6) else min(COLUMNS, len(subjects))
    left, right, gap, tall = 0.85, 0.1, 0.14, 2.1
    width = min(4.0, (WIDTH - left - right - (across - 1) * gap) / across)
    titles = {subject: wrapped(f"{subject}\u00a0*" if subject in starred else subject, width) for subject in subjects}
    above = between = 0.2 + 0.16 * (1 + max(title.count("\n") for title in titles.values()))
    if any(n + across >= len(subjects) for n in range(across - 1, len(subjects) - 1, across)):
        between += 0.2      # for the numbers of a panel with nothing below it
    down = math.ceil(len(subjects) / across)
    foot = 0.65 + sum(key_height(*group) for group in keys)
    figure = blank(above + down * tall + (down - 1) * between + foot)
    for n, subject in enumerate(subjects):
        i, k = divmod(n, across)
        bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
        panel = add_axes(figure, left + k * (width + gap), bottom, width, tall)
        prepare(panel, (width, tall))
        draw(panel, [finding for finding in found if finding.subject == subject])
        last = n + across >= len(subjects)
        panel.tick_params(top=True, right=True, labelleft=k == 0, labelbottom=last)
        panel.set_title(titles[subject], fontsize=11, pad=5, linespacing=1.0)
        if last:
            panel.set_xlabel(x_label)
        if k == 0:
            panel.set_ylabel(y_label)
    legend, *_ = stacked_legends(figure, left, keys)
    hover.mark_legend(legend, keys[0][0])
    return figure


def key_height(keys, columns):
    return math.ceil(len(keys) / columns) * LINE * 1.6


def stacked_legends(figure, left, groups):
    """Legends [({label: handle}, columns)] one below another at the foot of the figure."""
    bottom, legends = 0.1 + sum(key_height(*group) for group in groups), []
    for keys, columns in groups:
        bottom -= key_height(keys, columns)
        legends.append(foot_legend(figure, left, keys.values(), keys.keys(), columns, spacing=1.6, bottom=bottom))
    return legends


def wrapped(subject, width):
    return textwrap.fill(names.literal(subject), max(14, int(width / 0.072)), break_on_hyphens=False)
