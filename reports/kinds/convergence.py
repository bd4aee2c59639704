"""The figures of convergence studies: error against the theory's variable for each, error against run time for all.

A figure is a function of result files alone: the same files give the same bytes. Nothing is fitted here; orders,
intervals and verdicts are those of the result file.
"""

from dataclasses import astuple, dataclass
import math
import textwrap

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes
from drawing.look import COLORS, DASHES, DEPARTING, GRAY, LEGEND, LINE, MARKERS, WIDTH, Drawing, blank, typography
from reading import names
from reading.results import CONVERGENCE


@dataclass(frozen=True)
class Style:
    """How the curves of one scheme look; marker and fill show kernel and divergence form, the color the scheme."""
    color: str
    marker: str
    dash: object
    filled: bool

    def line(self, **more):
        # An open marker is wider than a filled one and see-through: where the two forms agree, both stay visible.
        return dict(color=self.color, marker=self.marker, linestyle=self.dash,
                    markerfacecolor=self.color if self.filled else "none", markersize=4.4 if self.filled else 7.0,
                    zorder=3 if self.filled else 4, **more)


def scheme_styles(studies):
    """A style for every scheme of the studies, in order of appearance: a scheme looks the same in every figure."""
    return styles_of(series.scheme for study in studies if study.kind == CONVERGENCE for series in study.series
                     if not series.stepping)


def styles_of(schemes):
    """{scheme: style}, in order of appearance."""
    styles, families = {}, []
    for scheme in schemes:
        if scheme in styles:
            continue
        family = (scheme.model, scheme.kernel, scheme.alpha, scheme.mu)
        if family not in families:
            families.append(family)
        i = len(styles)
        styles[scheme] = Style(COLORS[i % len(COLORS)], MARKERS[families.index(family) % len(MARKERS)],
                               DASHES[i % len(DASHES)], scheme.divergence != "nonlocal")
    return styles


# ---------------------------------------------------------------------------------------------- error of one study

def drawings(study, styles):
    """The figures of a convergence study."""
    figure = error_figure(study, styles)
    if figure is None:
        return []
    paths = ", ".join(dict.fromkeys(series.path for series in study.series))
    against = "" if study.scene.u else (
        " Errors are differences to a finer run, whose own error is missing in them: curves bend down near it, and "
        "orders make up for it.")
    return [Drawing(
        study.name, study.title, figure,
        f"Log-log plot of the max-norm error at the final time for {study.title}; paths: {paths}. "
        "Values: tables below.",
        "Error of each scheme along each path; the thin line has theory's slope. Limit order: that of a power law "
        "with a correction, to which the order tends under refinement, with its 95 % interval; with three "
        "levels the order is that of a power law alone. Numbers above a panel: particles N." + against)]


def error_figure(study, styles):
    """Max-norm error at T against the theory's variable, a panel per path; None if the study has no series."""
    if not study.series:
        return None
    with typography():
        panels = _by_path(study.series)
        labels = names.scheme_names(series.scheme for series in study.series)
        curves = [[_curve(series, styles[series.scheme]) for series in group] for group in panels.values()]
        room = _legend_room(len(panels))
        legends = [[_legend_text(series, labels[series.scheme], room) for series in group]
                   for group in panels.values()]
        deepest = max(sum(LINE * (text.count("\n") + 1.6) for text in texts) for texts in legends)
        figure, frames = panel_frames(len(panels), below=deepest if len(panels) > 1 else 0, above=0.54)
        bounds, references = axes.error_bounds(list(zip(curves, map(_orders, panels.values()))), frames[0].inches)
        for frame, (path, group), drawn, lines, texts in zip(frames, panels.items(), curves, references, legends):
            _error_panel(frame, path, group, drawn, bounds, lines)
            _legend(frame, group, drawn, texts, beside=len(panels) == 1)
            if frame.first:
                measured = "error" if study.scene.u else "difference to a finer run"
                frame.axes.set_ylabel(f"max-norm {measured} at $T = {study.scene.T:.4g}$")
        return figure


def _error_panel(frame, path, group, curves, bounds, references):
    panel = frame.axes
    panel.set_title(names.path_math(path), pad=21)
    for x, y, style in curves:
        panel.plot(x, y, **style.line())
    axes.set_log_limits(panel, axes.x_limits(curves), bounds, frame.inches)
    axes.name_levels(panel, [(series.cases.variable, series.cases.N) for series in group], frame.inches[0],
                     lead=frame.first)
    axes.draw_references(panel, references, frame.inches, GRAY)
    panel.tick_params(labelleft=frame.first)
    panel.set_xlabel(" or ".join(dict.fromkeys(names.variable_math(series.theory_variable) for series in group)))


def _legend(frame, group, curves, texts, beside):
    place = (1.04, 1.0) if beside else (0, -0.52 / frame.inches[1])
    legend = frame.axes.legend([Line2D([], [], **style.line()) for *_, style in curves], texts, loc="upper left",
                               bbox_to_anchor=place, **LEGEND)
    for text, series in zip(legend.get_texts(), group):
        text.set_color("black" if series.as_expected else DEPARTING)
        text.set_linespacing(1.12)


def _curve(series, style):
    """(x, y, style) with NaN where a level cannot be drawn on logarithmic axes: the curve breaks there."""
    x, y = series.cases.variable, series.cases.error_linf
    drawable = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    return np.where(drawable, x, np.nan), np.where(drawable, y, np.nan), style


def _orders(group):
    return sorted({series.theory_order for series in group if math.isfinite(series.theory_order)})


def _legend_room(panels):
    """Characters that fit into a line of the legend beside a single panel, or below one of several."""
    return 62 if panels in (2, 4) else 40


def _legend_text(series, name, room):
    theory = names.order(series.theory_order, "{:g}")
    if math.isfinite(series.observed_order):
        interval = f"[{names.order(series.observed_low)}, {names.order(series.observed_high)}]"
        order = "limit order" if series.observed_order == series.extrapolated_order else "order"
        lines = [name, f"{order} {names.order(series.observed_order)} {interval}, theory {theory}"]
    else:
        lines = [name, f"order not available, theory {theory}"]
    if not series.as_expected:
        lines.append(f"{series.verdict}, expected {series.expected}")
    elif series.verdict != "confirmed":
        lines.append(series.verdict)
    errors = series.cases.error_linf
    for count, what in ((np.sum(~np.isfinite(errors)), "not finite"), (np.sum(errors == 0), "zero")):
        if count:
            lines.append(f"{count} of {len(errors)} levels {what}")
    return "\n".join(names.literal(part) for line in lines for part in textwrap.wrap(line, room))


# ----------------------------------------------------------------------------------------- error against run time

def cost_drawings(studies, styles):
    """The cost figure, or nothing."""
    figure = cost_figure(studies, styles)
    return [] if figure is None else [Drawing(
        "cost", "Error against run time", figure,
        "Log-log plot of the max-norm error against the run time of every scheme, a panel per path. "
        "Values: tables above.",
        "Run time of the whole time loop, or a case's share of it where several advance on the same particles: median of "
        "the repeats, bars from the fastest to the slowest. Comparable only between runs of one machine. Series run by several studies are drawn once.")]


def cost_curves(studies):
    """Each series once, though several studies may have run it; of such doubles, the first with the most cases.

    Differences to a finer run are no errors; they are left out.
    """
    curves = {}
    for study in studies:
        timed = study.kind == CONVERGENCE and not study.steps_in_several_ways and study.scene.u
        for series in study.series if timed else ():
            key = (series.scheme, series.path, series.delta_text, series.source, series.step_text,
                   series.integrator, astuple(study.scene))
            if key not in curves or len(series.cases) > len(curves[key][1].cases):
                curves[key] = (study, series)
    return list(curves.values())


def cost_figure(studies, styles):
    """Max-norm error against run time of every series of the studies, a panel per path; None if there is none."""
    chosen = cost_curves(studies)
    if not chosen:
        return None
    with typography():
        entries = _cost_entries(chosen, styles)
        panels = {}
        for (_, series), entry in zip(chosen, entries):
            panels.setdefault(series.path, []).append((series.cases, *entry))
        legend = dict(sorted(entries, key=lambda entry: entry[0]))
        columns = 2 if max(map(len, legend)) > 32 else 3
        foot = math.ceil(len(legend) / columns) * LINE * 1.5 + 0.15
        figure, frames = panel_frames(len(panels), below=0, above=0.4, foot=foot)
        timed = [case for _, series in chosen for case in zip(series.cases.seconds, series.cases.error_linf)
                 if all(math.isfinite(value) and value > 0 for value in case)]
        seconds, errors = np.array(timed).T if timed else (np.array([]), np.array([]))
        for frame, (path, drawn) in zip(frames, panels.items()):
            frame.axes.set_title(names.path_math(path))
            for cases, _, style in drawn:
                _cost_curve(frame.axes, cases, style)
            axes.set_log_limits(frame.axes, axes.padded(seconds), axes.padded(errors), frame.inches)
            frame.axes.minorticks_off()     # they would take half of the drawing time
            if frame.first:
                frame.axes.set_ylabel("max-norm error at $T$")
            if frame.last:
                frame.axes.set_xlabel("run time (s)")
            frame.axes.tick_params(labelleft=frame.first, labelbottom=frame.last)
        figure.legend([Line2D([], [], **style.line()) for style in legend.values()], map(names.literal, legend),
                      loc="lower left", bbox_to_anchor=(frames[0].left, 0.1 / figure.get_figheight()), ncol=columns,
                      columnspacing=2.0, **LEGEND)
        return figure


def _cost_curve(panel, cases, style):
    drawable = (cases.seconds > 0) & np.isfinite(cases.seconds) & (cases.error_linf > 0) & np.isfinite(cases.error_linf)
    x = np.where(drawable, cases.seconds, np.nan)
    y = np.where(drawable, cases.error_linf, np.nan)
    if not drawable.any():
        return
    spread = np.nan_to_num(np.clip([x - cases.seconds_low, cases.seconds_high - x], 0, None))
    panel.errorbar(x, y, xerr=spread, ecolor=style.color, elinewidth=0.9, capsize=2, capthick=0.9, **style.line())


def _cost_entries(chosen, styles):
    """(legend text, style) of every curve: the scheme, and what else tells apart two curves of it in one panel."""
    labels = names.scheme_names(series.scheme for _, series in chosen)
    groups = {}
    for study, series in chosen:
        groups.setdefault((series.path, series.scheme), []).append(_circumstances(study, series))
    entries, variants = [], {}
    for study, series in chosen:
        found, twins = _circumstances(study, series), groups[series.path, series.scheme]
        told = [text for i, text in enumerate(found) if len({twin[i] for twin in twins}) > 1]
        seen = variants.setdefault(series.scheme, {})
        shift = seen.setdefault(tuple(told), len(seen))
        style = styles[series.scheme]
        if shift:
            dash = DASHES[(DASHES.index(style.dash) + shift) % len(DASHES)]
            style = Style(style.color, style.marker, dash, style.filled)
        entries.append((", ".join([labels[series.scheme], *told]), style))
    return entries


def _circumstances(study, series):
    return (f"δ = {series.delta_text}", f"{series.source} source", f"step {series.step_text}", series.integrator,
            f"scene {study.scene.name}", f"study {study.name}" if not study.scene.name else f"T = {study.scene.T:.4g}")


# ------------------------------------------------------------------------------------------------------- the frames

@dataclass(frozen=True)
class Frame:
    """One panel: its axes, its size (width, height) in inches and its place in the grid of panels."""
    axes: object
    inches: tuple
    left: float     # of the axes, as a fraction of the figure's width
    first: bool     # leftmost of its row
    last: bool      # nothing below it


def panel_frames(count, above, below, foot=0.0):
    """A figure with `count` panels, at most three a row; inches `above` and `below` every row and at the `foot`."""
    columns = count if count <= 3 else 2 if count == 4 else 3
    rows = math.ceil(count / columns)
    left, right, gap, label = 0.78, 0.1, 0.2, 0.55
    # Beside a single panel stands its legend, unless the legend is at the foot.
    width = 5.2 if count == 1 and not foot else (WIDTH - left - right - (columns - 1) * gap) / columns
    height = 3.6 if count == 1 else 2.6
    # Panels that share both axes name the lower one below the last row alone.
    row = above + height + (0.0 if foot else label + below)
    total = rows * row + (label + foot if foot else 0.1)
    figure = blank(total)
    frames = []
    for i in range(count):
        x = left + (i % columns) * (width + gap)
        y = total - (i // columns) * row - above - height
        panel = figure.add_axes((x / WIDTH, y / total, width / WIDTH, height / total), xscale="log", yscale="log")
        panel.tick_params(which="both", top=True, right=True)
        frames.append(Frame(panel, (width, height), left / WIDTH, i % columns == 0, i + columns >= count))
    return figure, frames


def _by_path(series):
    panels = {}
    for one in series:
        panels.setdefault(one.path, []).append(one)
    return panels
