"""Error against run time of all convergence studies together."""

from dataclasses import astuple
import math

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes, hover
from drawing.frames import panel_frames
from drawing.look import DASHES, LINE, Drawing, foot_legend, slug, typography
from drawing.styles import Style
from drawing.timed import error_over_seconds
from reading import names


def drawings(studies, styles, scene):
    """The cost figure of the studies of one scene, or nothing."""
    figure = cost_figure(studies, styles)
    return [] if figure is None else [Drawing(
        f"cost.{slug(scene)}", f"Error against run time: {scene}", figure,
        f"Log-log plot of the max-norm error against the run time of every scheme on the scene {scene}, a panel per "
        "path. Values: tables below.",
        f"Scene {scene}. Run time of the whole time loop, or a case's share of it where several advance on the same "
        "particles: median of the repeats, bars from the fastest to the slowest. Comparable only between runs of one "
        "machine. Series run by several studies are drawn once.")]


def cost_curves(studies):
    """Each series once, though several studies may have run it; of such doubles, the first with the most cases.

    Differences to a finer run are no errors; they are left out.
    """
    curves = {}
    for study in studies:
        for series in (finding.series for finding in study.findings if study.scene.u):
            key = (series.scheme, series.path, series.delta_text, series.source, series.step_text, series.integrator,
                   astuple(study.scene))
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
            for cases, text, style in drawn:
                error_over_seconds(frame.axes, cases, name=text, about=path, **style.line())
            axes.set_log_limits(frame.axes, axes.padded(seconds), axes.padded(errors), frame.inches)
            frame.axes.minorticks_off()     # they would take half of the drawing time
            if frame.first:
                frame.axes.set_ylabel("max-norm error at $T$")
            if frame.last:
                frame.axes.set_xlabel("run time (s)")
            frame.axes.tick_params(labelleft=frame.first, labelbottom=frame.last)
        key = foot_legend(figure, frames[0].left, [Line2D([], [], **style.line()) for style in legend.values()],
                          map(names.literal, legend), columns)
        hover.mark_legend(key, legend)
        return figure


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
