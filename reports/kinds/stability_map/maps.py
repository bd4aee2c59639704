"""Where steps are stable: maps of the growth over horizon and CFL number, with the limits on top.

Reading findings only: every limit and bound that is drawn is one of the result file.
"""

from functools import partial

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import Normal, Stroke
import matplotlib
import numpy as np

from drawing import axes
from drawing.look import COLORS, DASHES, DEPARTING, WIDTH, Drawing, add_axes, blank, foot_legend, slug, typography
from kinds.stability_map.panels import COLUMNS, wrapped
from reading import names
from kinds.stability_map.findings import (NORM, SEARCH_END, SPECTRAL, WITHIN, allowed_growth, integrator_of, lemma,
                                    of_kind, ordered, parts, plane, subject_of)

# Growth relative to what is allowed: the first band is what keeps to it.
LEVELS = (1.0, 3.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6)
LEMMA = COLORS[0]


def _shown_arrangement(found):
    """Real motion where there is any, for what grows along it is what counts."""
    arrangements = list(dict.fromkeys(parts(finding)[0] for finding in found))
    return "moved" if "moved" in arrangements else arrangements[0]


def drawings(study):
    found = [finding for finding in of_kind(study, "map") if plane(finding)[2].size]
    if not found:
        return
    arrangement, allowed = _shown_arrangement(found), allowed_growth(found)
    found = [finding for finding in found if parts(finding)[0] == arrangement]
    together = len(ordered(found, subject_of)) <= COLUMNS
    for statement in [""] if together else ordered(found, lemma):
        shown = [finding for finding in found if together or lemma(finding) == statement]
        yield _map_drawing(study, shown, arrangement, allowed, slug(statement))


def _map_drawing(study, found, arrangement, allowed, part):
    """`part`: of the file name, where the study has several maps."""
    beyond = {integrator_of(one) for one in found
              if not np.all(band(one.points.value, allowed) == 0) or not one.as_expected}
    quiet = [one for one in ordered(found, integrator_of) if one not in beyond]
    if not beyond:
        quiet = quiet[1:]
    drawn = [finding for finding in found if integrator_of(finding) not in quiet]
    lemmas = ordered(found, lemma)
    until = "T" if study.scene is None else f"T = {study.scene.T:g}"
    relative = f", over exp(CT) ≈ {allowed:.3g}, which theory allows" if allowed > WITHIN else ""
    left_out = (f" Not drawn, for they keep to what is allowed everywhere: {', '.join(quiet)}." if quiet else "")
    taken_for = "; for a control, of the scheme that it is taken for" if any(one.control for one in drawn) else ""
    return Drawing(
        ".".join(filter(None, (study.name, part))), ": ".join((study.title, " and ".join(lemmas))),
        partial(map_figure, drawn, study, allowed),
        f"Color maps of the growth of all steps over delta/h and CFL number on {arrangement} particles, a panel per "
        f"scheme and integrator, with the bound of {' and '.join(lemmas)} and the sharp limits. Values: table below.",
        f"Color: max norm of all steps to {until} on {arrangement} particles{relative}; a cell per measured value. Far "
        f"above the limits T holds but a few steps, in which little can grow.{left_out} Lines: the CFL number that the "
        "lemma prints, what the rows of the scheme need, times what the integrator makes of it (its radius of "
        f"monotonicity{taken_for}), and the largest CFL numbers, by bisection, at which no single step grows beyond "
        "φ(CΔt), φ its stability function, in the max norm and in the spectral radius. A line that leaves a panel "
        "above goes to a value there, or to none.",
        tuple(f"{one}, {kind}" for one in lemmas for kind in ("map", NORM, SPECTRAL)),
        says=_says([finding for finding in found if not finding.control], allowed))


def _says(found, allowed):
    """Up to which CFL number nothing grows beyond what is allowed, the least over all schemes and integrators."""
    least = []
    for finding in found:
        beyond = band(finding.points.value, allowed) > 0
        if beyond.any():
            least.append((finding.points.variable[beyond].min(), f"{finding.subject}, {integrator_of(finding)}"))
    if not least:
        return "Nothing grows beyond what is allowed, at any CFL number and horizon of the map."
    cfl, where = min(least)
    return f"Growth beyond what is allowed begins at a CFL number of {cfl:.3g} ({where})."


def map_figure(found, study, allowed):
    """A column per scheme, a row per integrator; growth over what is allowed as color, the study's limits as lines."""
    with typography():
        limits = [finding for kind in (SPECTRAL, NORM) for finding in of_kind(study, kind)]
        subjects, integrators = ordered(found, subject_of), ordered(found, integrator_of)
        planes = {(subject_of(one), integrator_of(one)): (one, *plane(one)) for one in found}
        left, right, gap, between, foot = 0.75, 1.15, 0.14, 0.1, 0.95
        blocks = _blocks(subjects, integrators, planes)
        across = max(len(block) for block, _ in blocks)
        width = min(3.6, (WIDTH - left - right - (across - 1) * gap) / across)
        tall = 1.25
        titles = {subject: wrapped(subject, width) for subject in subjects}
        above = 0.36 + 0.16 * max(title.count("\n") + 1 for title in titles.values())
        heights = [above + len(rows) * (tall + between) - between for _, rows in blocks]
        figure = blank(sum(heights) + (len(blocks) - 1) * 0.4 + foot)
        x_limits = _hull(edges(ratios) for _, ratios, _, _ in planes.values())
        y_limits = _hull(edges(cfl) for _, _, cfl, _ in planes.values())
        colors, norm = _colors()
        marked = False
        for b, (block, rows) in enumerate(blocks):
            top = figure.get_figheight() - sum(heights[:b]) - b * 0.4 - above
            for i, integrator in enumerate(rows):
                for k, subject in enumerate(block):
                    if (subject, integrator) not in planes:
                        continue
                    finding, *values = planes[subject, integrator]
                    panel = add_axes(figure, left + k * (width + gap), top - (i + 1) * tall - i * between, width, tall,
                                     xscale="log", yscale="log")
                    _draw_plane(panel, *values, allowed, colors, norm)
                    marked |= _draw_limits(panel, [one for one in limits if (one.subject, parts(one)) ==
                                                   (subject, parts(finding))])
                    axes.set_log_limits(panel, x_limits, y_limits, (width, tall))
                    panel.minorticks_off()
                    below = any((subject, other) in planes for other in rows[i + 1:])
                    panel.tick_params(direction="out")
                    # The axes of all panels are the same: ticks at the outer ones are enough.
                    if k > 0:
                        panel.set_yticks([])
                    if below:
                        panel.set_xticks([])
                    if not below:
                        panel.set_xlabel(r"$\delta/h$", labelpad=1)
                    if k == 0:
                        panel.set_ylabel(f"{names.literal(integrator)}\nCFL number", fontsize=10.5)
                    if not any((subject, other) in planes for other in rows[:i]):
                        panel.set_title(titles[subject], fontsize=11, pad=5, linespacing=1.0)
                    if not finding.as_expected:
                        panel.spines[:].set_color(DEPARTING)
                        panel.spines[:].set_linewidth(2)
        _color_key(figure, colors, norm, left + across * (width + gap), above, heights[0] - above, allowed)
        figure.text(left / WIDTH, 1 - 0.06 / figure.get_figheight(), f"{parts(found[0])[0]} particles", va="top",
                    fontsize=11)
        _line_key(figure, ordered(found, lemma), left, marked)
        return figure


def _blocks(subjects, integrators, planes):
    """[(subjects, integrators)]: subjects beside one another have planes of the same integrators, for no gap to stay."""
    alike = {}
    for subject in subjects:
        rows = tuple(integrator for integrator in integrators if (subject, integrator) in planes)
        alike.setdefault(rows, []).append(subject)
    return [(group[i:i + COLUMNS], rows) for rows, group in alike.items() for i in range(0, len(group), COLUMNS)]


def edges(values):
    """Edges of the cells around ascending positive values, half way between them on a logarithmic axis."""
    logs = np.log(values)
    if len(logs) == 1:
        return values[0] * np.array([0.75, 1 / 0.75])
    middle = (logs[1:] + logs[:-1]) / 2
    return np.exp([2 * logs[0] - middle[0], *middle, 2 * logs[-1] - middle[-1]])


def _hull(all_edges):
    every = np.concatenate(list(all_edges))
    return every.min(), every.max()


def _colors():
    """A color per band: pale where growth keeps to what is allowed, black-purple from the last level on."""
    scale = matplotlib.colormaps["magma_r"](np.linspace(0.02, 0.9, len(LEVELS) + 1))
    colors = ListedColormap(scale)
    return colors, BoundaryNorm(range(len(LEVELS) + 2), len(LEVELS) + 1)


def band(values, allowed):
    """Of each value the number of levels that it exceeds; NaN for NaN."""
    relative = np.asarray(values) / (allowed * WITHIN)
    return np.where(np.isnan(relative), np.nan, np.searchsorted(LEVELS, relative, side="left"))


def _draw_plane(panel, ratios, cfl, values, allowed, colors, norm):
    """Cells of equal color beside one another as one; a hole where there is no value."""
    x, y, bands = edges(ratios), edges(cfl), band(values, allowed)
    corners = {}
    for k, row in enumerate(bands):
        ends = [i for i in range(1, len(row)) if row[i] != row[i - 1]]
        for start, end in zip([0, *ends], [*ends, len(row)]):
            if not np.isnan(row[start]):
                corners.setdefault(row[start], []).append(
                    [(x[start], y[k]), (x[end], y[k]), (x[end], y[k + 1]), (x[start], y[k + 1]), (x[start], y[k])])
    for value, cells in corners.items():
        color = colors(norm(value))
        # Without edges viewers show seams.
        panel.add_patch(PathPatch(Path.make_compound_path(*map(Path, cells)), facecolor=color, edgecolor=color,
                                  linewidth=0.3))


def _draw_limits(panel, limits):
    """The lemma's CFL number 1 and the limits of one panel; whether somewhere no step is stable."""
    panel.axhline(1.0, color=LEMMA, linewidth=2.2, zorder=3)
    none = False
    for finding in limits:
        x, y, lower = finding.points.variable, finding.points.value, finding.points.lower
        in_norm = finding.statement.endswith(NORM)
        line, = panel.plot(x, np.where(y > 0, y, np.nan), **_LIMIT[in_norm], zorder=5)
        line.set_path_effects(_HALO)
        if not in_norm:
            continue
        panel.plot(x, np.where((lower > 0) & np.isfinite(lower), lower, np.nan), zorder=6, **_OF_ROWS)
        if np.any(y == 0):
            none = True
            panel.plot(x[y == 0], np.full(np.sum(y == 0), 0.06), transform=panel.get_xaxis_transform(), **_NONE)
            panel.annotate("none", (x[y == 0][0], 0.12), xycoords=panel.get_xaxis_transform(), ha="center",
                           va="bottom", fontsize=9, path_effects=_HALO)
        if np.all(y >= SEARCH_END):
            panel.annotate(f"no limit up to {SEARCH_END:g}", (0.5, 0.93), xycoords="axes fraction", ha="center",
                           va="top", fontsize=9, path_effects=_HALO)
    return none


_HALO = [Stroke(linewidth=2.8, foreground="white", alpha=0.8), Normal()]
_LIMIT = {True: dict(color="black", linewidth=1.5, marker="o", markersize=3.4),
          False: dict(color="black", linewidth=0.8, linestyle=DASHES[5])}
_OF_ROWS = dict(color="#2FB68A", linewidth=1.5, linestyle=(0, (4, 2.2)))
_NONE = dict(linestyle="none", marker="x", markersize=5, color="black", clip_on=False, zorder=7)


def _color_key(figure, colors, norm, left, above, height, allowed):
    bottom = figure.get_figheight() - above - height
    bar = figure.colorbar(ScalarMappable(norm, colors),
                          cax=add_axes(figure, left + 0.05, bottom, 0.16, height, Axes))
    bar.set_ticks(range(1, len(LEVELS) + 1), labels=[axes.tick_text(level, [1e-9]) if level > 10 else f"{level:g}"
                                                     for level in LEVELS])
    bar.minorticks_off()
    over = r" / $e^{CT}$" if allowed > WITHIN else ""
    bar.set_label(f"growth over $T${over}", labelpad=2)
    bar.ax.annotate("and more", (1, 1), xycoords="axes fraction", xytext=(5, 0), textcoords="offset points",
                    va="top", fontsize=9)
    bar.ax.annotate("none" if allowed <= WITHIN else "allowed", (1, 0), xycoords="axes fraction", xytext=(5, 0),
                    textcoords="offset points", va="bottom", fontsize=9)


def _line_key(figure, lemmas, left, marked):
    keys = {f"{' and '.join(lemmas)}: CFL number 1": Line2D([], [], color=LEMMA, linewidth=2.2),
            "sharp limit, max norm": Line2D([], [], **_LIMIT[True]),
            "sufficient, by the rows of the scheme": Line2D([], [], **_OF_ROWS),
            "sharp limit, spectral radius": Line2D([], [], **_LIMIT[False])}
    if marked:
        keys["no CFL number is stable"] = Line2D([], [], **_NONE)
    foot_legend(figure, left, keys.values(), keys.keys(), 3 if marked else 2)
