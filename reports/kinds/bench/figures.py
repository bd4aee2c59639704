"""Figures of benches: error against seconds and against work, where the time goes, and how run times scale."""

import math

from matplotlib.lines import Line2D
from matplotlib.patches import Patch
import numpy as np

from drawing import axes, hover
from drawing.frames import panel_frames
from drawing.look import COLORS, GRAY, LEGEND, LINE, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from drawing.styles import styles_of
from drawing.timed import BARS, EFFICIENT, mark_frontier
from kinds.bench import tables as bench_tables, way_figures
from reading import bench_results, names, work_precision

# Positions, velocities, pair sums, source, rest: told apart by hatching too.
FILLS = ((COLORS[1], ""), (COLORS[5], "////"), (COLORS[0], ""), (COLORS[2], "...."), ("#C8C8C8", ""))
SLOPE = dict(color=GRAY, linewidth=0.8, zorder=2)


def drawings(benches, styles):
    """The figures of benches that have something to show. `styles`: {scheme: Style} of the other figures."""
    styles = styles_of([*styles, *(curve.scheme for bench in benches for curve in bench.curves)])
    compared = [curve for curve in bench_tables.compared(benches) if len(curve)]
    found = []
    if compared:
        found += [
            Drawing("bench.seconds", "Error against seconds", error_figure(compared, styles, "seconds"),
                    "Log-log plot of the max-norm error against run time, a panel per path. Values: tables below.",
                    "Seconds of the whole time loop with one thread: medians of runs that took turns; bars from the "
                    "minimum to the median plus twice the median absolute deviation, mostly smaller than the marker. "
                    "On gray, with N: the efficient frontier, the runs that no other run of the panel beats in both "
                    "error and seconds.", says=_says(compared)),
            Drawing("bench.work", "Error against work", error_figure(compared, styles, "pairs"),
                    "Log-log plot of the max-norm error against the number of pair interactions, a panel per path.",
                    "The same errors against pair interactions, which no machine disturbs. On gray: the efficient "
                    "frontier."),
            Drawing("bench.parts", "Where the time goes", parts_figure(compared),
                    "Stacked bars of the parts of the run time of each scheme and path. Values: table below.",
                    "Parts of the median run time at the largest N of each scheme and path. Weights that are stored "
                    "are part of the velocities; those that are computed where they are used are part of the pair "
                    "sums, and so are windows. Rest: stages, set-up, and the watch over bounds and growth.")]
    found += way_figures.drawings(benches)
    scaling = scaling_figure(benches, styles)
    if scaling:
        found.append(Drawing(
            "bench.scaling", "Scaling", scaling,
            "Log-log plots of seconds against N, against the horizon in spacings, and against threads.",
            "Seconds per step, of runs of a few steps including their set-up: against N, against the horizon at one N, "
            "and against threads. Bars as above; thin lines beside threads: the ideal."))
    return found


# ------------------------------------------------------------------------------------------------ error against cost

def _says(curves):
    """The cheapest run for each of some errors, by scene and by what the error is against."""
    groups = {}
    for curve, text in zip(curves, bench_tables.labels(curves)):
        groups.setdefault((curve.scene, curve.T, curve.source), []).append((curve, text))
    said = []
    for (scene, T, source), group in groups.items():
        runs = [(seconds, error, f"{text}, {curve.path}, N = {N}") for curve, text in group
                for seconds, error, N in zip(*_points(curve, "seconds"), curve.N) if math.isfinite(seconds)]
        found = [f"{min(errors):g} in {seconds:.2g} s ({what})"
                 for (seconds, _, what), errors in work_precision.cheapest(runs).items()]
        target = "local equation" if source == "local" else "nonlocal model"
        if found:
            said.append(f"Cheapest on {scene or 'a scene without a name'} to T = {T:.4g} for an error against the "
                        f"{target} of at most {'; '.join(found)}.")
    return " ".join(said)


def error_figure(curves, styles, cost):
    """Error against `cost`, "seconds" or "pairs", a panel per path."""
    with typography():
        texts = bench_tables.labels(curves)
        legend = {text: styles[curve.scheme] for curve, text in sorted(zip(curves, texts), key=lambda pair: pair[1])}
        panels, names_of = {}, dict(zip(curves, texts))
        for curve in curves:
            panels.setdefault(curve.path, []).append(curve)
        columns = 2
        foot = math.ceil((len(legend) + 1) / columns) * LINE * 1.5 + 0.15
        figure, frames = panel_frames(len(panels), below=0, above=0.4, foot=foot)
        points = {curve: _points(curve, cost) for curve in curves}
        x, y = (np.concatenate([point[i][np.isfinite(point[i])] for point in points.values()]) for i in (0, 1))
        for frame, (path, group) in zip(frames, panels.items()):
            panel = frame.axes
            panel.set_title(names.path_math(path))
            drawn = [points[curve] for curve in group]
            mark_frontier(panel, *map(np.concatenate, zip(*drawn)), np.concatenate([curve.N for curve in group]))
            for curve, (costs, errors) in zip(group, drawn):
                style = styles[curve.scheme]
                bars = _bars(curve.seconds, costs) if cost == "seconds" else None
                drawn_curve = panel.errorbar(costs, errors, xerr=bars, ecolor=style.color, **BARS, **style.line())
                hover.mark(drawn_curve, names_of[curve], path, N=curve.N, h=curve.h, δ=curve.delta,
                           seconds=curve.seconds.median, pairs=curve.pairs, **{"max-norm error": curve.error})
            axes.set_log_limits(panel, axes.padded(x), axes.padded(y), frame.inches)
            if frame.first:
                panel.set_ylabel("max-norm error at $T$")
            if frame.last:
                panel.set_xlabel("seconds" if cost == "seconds" else "pair interactions")
            panel.tick_params(labelleft=frame.first, labelbottom=frame.last)
        keys = [Line2D([], [], **style.line()) for style in legend.values()] + [Line2D([], [], **EFFICIENT)]
        key = foot_legend(figure, frames[0].left, keys, [*map(names.literal, legend), "efficient frontier"], columns)
        hover.mark_legend(key, [*legend, None])
        return figure


def _points(curve, cost):
    """(cost, error) with NaN where a level cannot be drawn on logarithmic axes."""
    x = curve.seconds.median if cost == "seconds" else curve.pairs
    return axes.drawable(x, curve.error)


def _bars(spread, drawn, per=1.0):
    """Lengths of the bars to both sides of the median."""
    below = np.where(np.isfinite(drawn), (spread.median - spread.minimum) / per, 0)
    above = np.where(np.isfinite(drawn), 2 * spread.deviation / per, 0)
    return [below, above]


# ------------------------------------------------------------------------------------------------- where the time goes

def parts_figure(curves):
    """A bar per scheme and path: the shares of the parts at its largest N."""
    with typography():
        curves = [curve for curve in curves if math.isfinite(curve.seconds.median[-1])]
        texts = bench_tables.labels(curves)
        groups = {}
        for curve, text in zip(curves, texts):
            groups.setdefault(text, []).append(curve)
        bar, between, left, right, foot, above = 0.21, 0.16, 3.75, 1.15, 0.55, 0.45
        height = len(curves) * bar + (len(groups) - 1) * between
        figure = blank(above + height + foot)
        panel = add_axes(figure, left, foot, WIDTH - left - right, height, xlim=(0, 100), ylim=(height, 0))
        at = 0.0
        for text, group in groups.items():
            panel.annotate(names.literal(text), (0, at + len(group) * bar / 2), xytext=(-72 * (left - 0.08), 0),
                           textcoords="offset points", xycoords=("axes fraction", "data"), va="center", fontsize=10)
            for curve in group:
                done = 0.0
                for share, (color, hatch) in zip(bench_tables.shares(curve).values(), FILLS):
                    panel.barh(at + bar / 2, 100 * share, left=done, height=0.8 * bar, color=color, hatch=hatch,
                               edgecolor="white", linewidth=0.4)
                    done += 100 * share
                panel.annotate(names.path_math(curve.path), (0, at + bar / 2), xytext=(-5, 0), va="center", ha="right",
                               textcoords="offset points", xycoords=("axes fraction", "data"), fontsize=9.5)
                panel.annotate(f"{curve.N[-1]}, {bench_tables.seconds(curve.seconds.median[-1])} s", (1, at + bar / 2),
                               xytext=(5, 0), textcoords="offset points", xycoords=("axes fraction", "data"),
                               va="center", fontsize=9.5, color=GRAY)
                at += bar
            at += between
        panel.set_yticks([])
        panel.set_xlabel("percent of the run time")
        panel.annotate("$N$, run time", (1, 1), xytext=(5, 5), textcoords="offset points", xycoords="axes fraction",
                       fontsize=9.5, color=GRAY)
        keys = [Patch(facecolor=color, hatch=hatch, edgecolor="white") for color, hatch in FILLS]
        figure.legend(keys, [*bench_tables.PART_NAMES.values(), "rest"], loc="upper left", ncol=5, columnspacing=1.4,
                      bbox_to_anchor=(0.1 / WIDTH, 1 - 0.08 / figure.get_figheight()),
                      **LEGEND | dict(handlelength=1.4))
        return figure


# ------------------------------------------------------------------------------------------------------------- scaling

def scaling_figure(benches, styles):
    """Seconds per step against N, against delta/h, against threads, as far as there are such studies; else None."""
    curves = [curve for bench in benches for curve in bench.curves
              if curve.threads == 1 and any(map(bench_results.is_scaling, curve.studies))]
    pairs = bench_tables.thread_pairs(benches)
    threaded = {curve.studies for _, curve in pairs}
    curves = [curve for curve in curves if curve.studies not in threaded and len(curve)]
    along_N = [curve for curve in curves if len(curve) > 1]
    along_horizon = _by_scheme([curve for curve in curves if len(curve) == 1])
    wanted = [draw for draw, have in ((_draw_along_N, along_N), (_draw_along_horizon, along_horizon),
                                      (_draw_along_threads, pairs)) if have]
    if not wanted:
        return None
    given = {_draw_along_N: along_N, _draw_along_horizon: along_horizon, _draw_along_threads: pairs}
    with typography():
        schemes = list(dict.fromkeys([curve.scheme for curve in curves] + [one.scheme for one, _ in pairs]))
        labels = names.scheme_names(schemes)
        left, gap, right, tall, above = 0.8, 0.72, 0.1, 2.7, 0.35
        foot = 0.6 + math.ceil(len(schemes) / 2) * LINE * 1.5 + 0.1
        width = min(3.6, (WIDTH - left - right - (len(wanted) - 1) * gap) / len(wanted))
        figure = blank(above + tall + foot)
        for i, draw in enumerate(wanted):
            panel = add_axes(figure, left + i * (width + gap), foot, width, tall, xscale="log", yscale="log")
            draw(panel, given[draw], styles, (width, tall))
            panel.minorticks_off()
            panel.tick_params(top=True, right=True)
            if i == 0:
                panel.set_ylabel("seconds per step")
        foot_legend(figure, left, [Line2D([], [], **styles[scheme].line()) for scheme in schemes],
                    [names.literal(labels[scheme]) for scheme in schemes], 2)
        return figure


def _by_scheme(curves):
    groups = {}
    for curve in curves:
        groups.setdefault(curve.scheme, []).append(curve)
    return groups


def _per_step(panel, x, seconds, deviation, minimum, style, **more):
    panel.errorbar(x, seconds, yerr=[seconds - minimum, 2 * deviation], ecolor=style.color, elinewidth=0.9, capsize=2,
                   capthick=0.9, **style.line(**more))


def _draw_along_N(panel, curves, styles, inches):
    every, paths = [], {}
    for curve in curves:
        per_step = [values / curve.steps for values in (curve.seconds.median, curve.seconds.deviation,
                                                        curve.seconds.minimum)]
        _per_step(panel, curve.N, *per_step, styles[curve.scheme])
        every.append((curve.N, per_step[0]))
        paths.setdefault(curve.path, []).append((curve, per_step[0]))
    panel.set_title("$N$ at fixed horizon or ratio", fontsize=11)
    panel.set_xlabel("$N$")
    _limits(panel, every, inches)
    # Above the highest lines, below all others: between them there may be no room.
    top = max(paths, key=lambda path: max(y[-1] for _, y in paths[path]))
    for path, group in paths.items():
        curve, y = (max if path == top else min)(group, key=lambda one: one[1][-1])
        offset, va = ((-8, 0), "center") if path == top else ((4, -30), "top")
        panel.annotate(names.path_math(path), (curve.N[-1], y[-1]), xytext=offset, textcoords="offset points",
                       ha="right", va=va, fontsize=10)
    _slopes(panel, (1, 2))


def _draw_along_horizon(panel, groups, styles, inches):
    every = []
    for scheme, curves in groups.items():
        curves = sorted(curves, key=lambda curve: curve.delta[0] / curve.h[0])
        x = np.array([curve.delta[0] / curve.h[0] for curve in curves])
        per_step = [np.array([getattr(curve.seconds, name)[0] / curve.steps[0] for curve in curves])
                    for name in ("median", "deviation", "minimum")]
        _per_step(panel, x, *per_step, styles[scheme])
        every.append((x, per_step[0]))
    N = {int(curve.N[0]) for curves in groups.values() for curve in curves}
    panel.set_title(r"horizon at $N = %d$" % N.pop() if len(N) == 1 else "horizon", fontsize=11)
    panel.set_xlabel(r"$\delta/h$")
    _limits(panel, every, inches)
    _slopes(panel, (1,))


def _draw_along_threads(panel, pairs, styles, inches):
    lines = {}
    for one, several in pairs:
        for i in range(len(one)):
            lines.setdefault((one.scheme, one.path, int(one.N[i])), {1: (one, i)})[several.threads] = (several, i)
    every = []
    for (scheme, path, N), found in lines.items():
        threads = np.array(sorted(found))
        per_step = [np.array([getattr(found[n][0].seconds, name)[found[n][1]] / found[n][0].steps[found[n][1]]
                              for n in threads]) for name in ("median", "deviation", "minimum")]
        _per_step(panel, threads, *per_step, styles[scheme])
        panel.plot(threads, per_step[0][0] / threads, **SLOPE)
        # Two that begin at nearly the same height would write over each other.
        crowded = any(abs(math.log(per_step[0][0] / y[0])) < 0.2 for _, y in every)
        panel.annotate(f"{names.path_math(path)}, $N={N}$", (threads[0], per_step[0][0]),
                       xytext=(7, 17 if crowded else 4), textcoords="offset points", fontsize=9)
        every += [(threads, per_step[0]), (threads, per_step[0][0] / threads)]
    panel.set_title("threads within one case", fontsize=11)
    panel.set_xlabel("threads")
    _limits(panel, every, inches)
    most = max(int(threads[-1]) for threads, _ in every)
    shown = [2 ** k for k in range(most.bit_length()) if 2 ** k <= most]
    panel.set_xticks(shown, [str(n) for n in shown])


def _limits(panel, every, inches):
    x, y = (np.concatenate([np.asarray(one[i], dtype=float) for one in every]) for i in (0, 1))
    axes.set_log_limits(panel, axes.padded(x, 0.09), axes.padded(y, 0.09), inches)


def _slopes(panel, slopes):
    """Short lines of these slopes in the lower right corner, which increasing curves leave free, with their names."""
    decades = [math.log10(high / low) for low, high in (panel.get_xlim(), panel.get_ylim())]
    across = min(0.2, 0.32 * decades[1] / decades[0] / max(slopes))
    left, bottom = 0.78 - across, 0.05
    for slope in slopes:
        up = slope * across * decades[0] / decades[1]
        panel.plot((left, left + across), (bottom, bottom + up), transform=panel.transAxes, **SLOPE)
        panel.annotate(f"slope {slope}", (left + across, bottom + up), xycoords="axes fraction", xytext=(3, 0),
                       textcoords="offset points", va="center", fontsize=9.5, color=GRAY)
