"""How the curves of findings look, one look for each subject, and their legend."""

import math

from matplotlib.lines import Line2D

from drawing import hover
from drawing.look import COLORS, DASHES, LINE, MARKERS, foot_legend
from reading import names

LEFT, RIGHT, GAP = 0.78, 0.1, 0.16     # inches beside and between panels


def subject_styles(found):
    """{subject: how its curves look}; open markers for the nonlocal divergence, as in every figure.

    Each is smaller than the one below it: curves of schemes that agree lie within one another.
    """
    subjects = list(dict.fromkeys(finding.subject for finding in found))
    styles = {}
    for i, subject in enumerate(subjects):
        color, above = COLORS[i % len(COLORS)], 1 - i / max(1, len(subjects) - 1)
        styles[subject] = dict(color=color, marker=MARKERS[i % len(MARKERS)], linewidth=1.0 + 1.0 * above,
                               linestyle=DASHES[i % len(DASHES)], markersize=3.4 + 3.6 * above, markeredgewidth=0.9,
                               markerfacecolor="none" if "nonlocal" in subject else color)
    return styles


def legend_columns(styles):
    return 2 if max(map(len, styles)) > 38 else 3


def legend_height(styles):
    return math.ceil(len(styles) / legend_columns(styles)) * LINE * 1.5 + 0.1


def subject_legend(figure, styles):
    key = foot_legend(figure, LEFT, [Line2D([], [], **style) for style in styles.values()], map(names.literal, styles),
                      legend_columns(styles))
    hover.mark_legend(key, styles)


def variable_math(name):
    formulas = {"delta": r"$\delta$", "delta/h": r"$\delta/h$", "h/delta": r"$h/\delta$"}
    return formulas.get(name) or names.variable_math(name)


def arrangement(finding):
    """That of the particles; where there are none, all that the check says."""
    return str(finding.coordinates.get("arrangement", finding.check))


def conditions(finding):
    """What the check says besides the arrangement."""
    return finding.check.removeprefix(arrangement(finding)).removeprefix(", ")
