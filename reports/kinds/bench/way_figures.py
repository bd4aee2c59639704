"""Error against seconds of all ways to step, a figure per scene."""

import math

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes, hover
from drawing.look import COLORS, DASHES, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, slug, typography
from drawing.timed import BARS, EFFICIENT, mark_frontier
from kinds.bench import ways as of_ways
from kinds.bench.texts import seconds
from reading import names, work_precision

RULES = ("by the lemma", "by rows", "equal steps", "adaptive")


def drawings(benches):
    return [Drawing(
        f"bench.ways.{slug(title)}", f"Error against seconds: {title}", scene_figure(groups),
        f"Log-log plots of the max-norm error against run time for {title}, a curve per way to step. Values: tables below.",
        "A row per path, a column per scheme. Each point is a run of a way that no other run of this way beats: of equal "
        "steps their length is chosen with N, of adaptive ones the tolerance. Medians; bars from the minimum to the median "
        "plus twice the median absolute deviation. On gray, with N: the runs that no run of any way beats. Ways that "
        "blow up are named in the legend.", says=_says(groups)) for title, groups in of_ways.scenes(benches).items()
        if any(not way.blows_up() for ways in groups.values() for way in ways.values())]


def _says(groups):
    """The quickest way to the smallest error of TARGETS that is reached."""
    said = []
    for (path, scheme), ways in groups.items():
        for target in reversed(of_ways.TARGETS):
            found = [(reach.seconds, name) for name, way in ways.items()
                     if np.isfinite((reach := of_ways.reach(way, target)).seconds)]
            if found:
                least, name = min(found)
                said.append(f"{names.model(scheme)}, {names.path_text(path)}: {work_precision.target_text(target)} in "
                            f"{seconds(least)} s ({name})")
                break
    return f"Quickest to the smallest error: {'; '.join(said)}." if said else ""


def scene_figure(groups):
    """A row per path, a column per scheme, a curve per way."""
    with typography():
        paths, schemes = (list(dict.fromkeys(of[i] for of in groups)) for i in (0, 1))
        labels = names.scheme_names(schemes)
        every = [way for ways in groups.values() for way in ways.values()]
        shown = list(dict.fromkeys(way.name for way in every))
        integrators = list(dict.fromkeys(map(_integrator, shown)))
        styles = {name: _style(integrators.index(_integrator(name)), RULES.index(name.rpartition(", ")[2]))
                  for name in shown}
        left, right, gap, above, between, tall = 0.85, 0.1, 0.16, 0.5, 0.3, 2.6
        foot = 0.75 + math.ceil((len(shown) + 1) / 2) * LINE * 1.6
        width = min(4.0, (WIDTH - left - right - (len(schemes) - 1) * gap) / len(schemes))
        figure = blank(above + len(paths) * tall + (len(paths) - 1) * between + foot)
        drawn = [axes.drawable(way.seconds.median, way.error) for way in every]
        x_limits, y_limits = (axes.padded(values[np.isfinite(values)])
                              for values in (np.concatenate([one[i] for one in drawn]) for i in (0, 1)))
        for (path, scheme), ways in groups.items():
            i, k = paths.index(path), schemes.index(scheme)
            bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
            panel = add_axes(figure, left + k * (width + gap), bottom, width, tall, xscale="log", yscale="log")
            for way in ways.values():
                _draw(panel, way.efficient(), styles[way.name], path)
            whole = [axes.drawable(way.seconds.median, way.error) for way in ways.values()]
            mark_frontier(panel, *map(np.concatenate, zip(*whole)), np.concatenate([way.N for way in ways.values()]))
            axes.set_log_limits(panel, x_limits, y_limits, (width, tall))
            last = i == len(paths) - 1
            panel.tick_params(top=True, right=True, labelleft=k == 0, labelbottom=last)
            if i == 0:
                panel.set_title(names.literal(labels[scheme]), fontsize=11, pad=20)
            panel.annotate(names.path_math(path), (0, 1), xycoords="axes fraction", xytext=(0, 4),
                           textcoords="offset points", va="bottom", fontsize=10.5)
            if last:
                panel.set_xlabel("seconds")
            if k == 0:
                panel.set_ylabel("max-norm error at $T$")
        keys = [*(Line2D([], [], **styles[name]) for name in shown), Line2D([], [], **EFFICIENT)]
        texts = [*(names.literal(_named(name, every)) for name in shown), "efficient frontier, with N"]
        hover.mark_legend(foot_legend(figure, left, keys, texts, 2), [*shown, None])
        return figure


def _draw(panel, way, style, path):
    x, y = axes.drawable(way.seconds.median, way.error)
    if np.all(np.isnan(x)):
        return
    bars = np.nan_to_num([x - way.seconds.minimum, 2 * way.seconds.deviation])
    curve = panel.errorbar(x, y, xerr=bars, ecolor=style["color"], **BARS, **style)
    hover.mark(curve, way.name, path, N=way.N, seconds=way.seconds.median, **{"steps by": way.said, "steps": way.steps,
                                                                               "max-norm error": way.error})


def _named(name, every):
    """A way, and whether it blows up somewhere."""
    lost = [way.blows_up() for way in every if way.name == name]
    return f"{name}: {of_ways.BLOWN}{'' if all(lost) else ' in some'}" if any(lost) else name


def _integrator(name):
    return name.partition(", ")[0]


def _style(integrator, rule):
    """The color says the integrator, marker and line the rule of its steps."""
    color = COLORS[integrator % len(COLORS)]
    return dict(color=color, marker=MARKERS[rule], linestyle=DASHES[rule], markersize=4.4, zorder=3)
