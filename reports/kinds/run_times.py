"""Error against run time, a figure per scene: errors of different problems do not compare."""

from dataclasses import astuple
import math

from matplotlib.lines import Line2D
import numpy as np

from drawing import axes, hover
from drawing.frames import panel_frames
from drawing.look import DASHES, LINE, MARKERS, Drawing, foot_legend, slug, typography
from drawing.styles import Style
from drawing.timed import EFFICIENT, error_over_seconds, mark_frontier
from reading import names, work_precision


def scenes(studies):
    """{name of a scene: the studies of it that have errors and run times to draw}.

    A scene without a name is called after the first study of it; T only tells scenes of one name apart.
    """
    found = {}
    for study in studies:
        if study.scene.u and any(_drawable(finding.series.cases).any() for finding in study.findings):
            found.setdefault(astuple(study.scene), []).append(study)
    named = {}
    for group in found.values():
        name = group[0].scene.name or group[0].name
        named[f"{name} to T = {group[0].scene.T:.4g}" if name in named else name] = group
    return named


def drawings(studies, styles, scene):
    """The figure of the studies of one of scenes(), `scene` being its name."""
    chosen = [(study, series) for study, series in cost_curves(studies) if _drawable(series.cases).any()]
    return [Drawing(
        f"cost.{slug(scene)}", f"Error against run time: {scene}", cost_figure(chosen, styles),
        f"Log-log plot of the max-norm error against the run time of every scheme on the scene {scene}, a panel per "
        "path. Values: tables of the studies.",
        f"Scene {scene}. Run time of the whole time loop, or a case's share of it where several advance on the same "
        "particles: median of the repeats, bars from the fastest to the slowest. On gray, with N: the efficient "
        "frontier, the runs that no other run of the panel beats in both error and time. Nonlocal: errors against "
        "the nonlocal model, at a fixed horizon. Comparable only between runs of one machine. Series run by several "
        "studies are drawn once.", says=_says(chosen))]


def cost_curves(studies):
    """Each series once, though several studies may have run it; of such doubles, the first with the most cases.

    Differences to a finer run are no errors; they are left out.
    """
    curves = {}
    for study in studies:
        for series in (finding.series for finding in study.findings if study.scene.u):
            key = (series.scheme, series.path, series.delta_text, series.source, series.step_text, series.integrator,
                   series.start, astuple(study.scene))
            if key not in curves or len(series.cases) > len(curves[key][1].cases):
                curves[key] = (study, series)
    return list(curves.values())


def cost_figure(chosen, styles):
    """Max-norm error against run time of the curves of a scene, a panel per path."""
    with typography():
        entries = _entries(chosen, styles)
        panels = {}
        for (_, series), entry in zip(chosen, entries):
            panels.setdefault((series.path, series.source), []).append((series.cases, *entry))
        legend = dict(sorted(entries, key=lambda entry: entry[0]))
        longest = max(map(len, legend))
        columns = 1 if longest > 56 else 2 if longest > 32 else 3
        foot = math.ceil((len(legend) + 1) / columns) * LINE * 1.5 + 0.15
        figure, frames = panel_frames(len(panels), above=0.4, below=0, foot=foot)
        points = {of: _points([cases for cases, *_ in drawn]) for of, drawn in panels.items()}
        seconds, errors = (np.concatenate([found[i] for found in points.values()]) for i in (0, 1))
        for frame, ((path, source), drawn) in zip(frames, panels.items()):
            frame.axes.set_title(names.path_math(path) + (", nonlocal" if source == "nonlocal" else ""))
            mark_frontier(frame.axes, *points[path, source])
            for cases, text, style in drawn:
                error_over_seconds(frame.axes, cases, name=text, about=path, **style.line())
            axes.set_log_limits(frame.axes, axes.padded(seconds, 0.09), axes.padded(errors, 0.09), frame.inches)
            if frame.first:
                frame.axes.set_ylabel("max-norm error at $T$")
            if frame.last:
                frame.axes.set_xlabel("run time (s)")
            frame.axes.tick_params(labelleft=frame.first, labelbottom=frame.last)
        key = foot_legend(figure, frames[0].left, [*(Line2D([], [], **style.line()) for style in legend.values()),
                                                   Line2D([], [], **EFFICIENT)],
                          [*map(names.literal, legend), "efficient frontier, with N"], columns)
        hover.mark_legend(key, [*legend, None])
        return figure


def _points(all_cases):
    """(seconds, error, N) of all cases that can be drawn."""
    return tuple(np.concatenate([getattr(cases, name)[_drawable(cases)] for cases in all_cases])
                 for name in ("seconds", "error_linf", "N"))


def _drawable(cases):
    """Which cases have an error and a run time that can be drawn."""
    return np.isfinite(axes.drawable(cases.seconds, cases.error_linf)[0])


def _entries(chosen, styles):
    """(legend text, style) of every curve: the scheme, and what else tells apart two curves of it in some panel."""
    labels = names.scheme_names(series.scheme for _, series in chosen)
    twins = {}      # of a scheme along one path
    for _, series in chosen:
        twins.setdefault(series.scheme, {}).setdefault(series.path, []).append(_circumstances(series))
    entries, variants = [], {}
    for _, series in chosen:
        told = tuple(text for i, text in enumerate(_circumstances(series))
                     if any(len({twin[i] for twin in group}) > 1 for group in twins[series.scheme].values()))
        seen = variants.setdefault(series.scheme, {})
        shift = seen.setdefault(told, len(seen))
        style = styles[series.scheme]
        if shift:
            dash = DASHES[(DASHES.index(style.dash) + shift) % len(DASHES)]
            style = Style(style.color, MARKERS[(MARKERS.index(style.marker) + 3 * shift) % len(MARKERS)], dash,
                          not style.filled)
        entries.append((", ".join([labels[series.scheme], *told]), style))
    return entries


def _circumstances(series):
    return (f"δ = {series.delta_text}", f"{series.source} source", f"step {series.step_text}", series.integrator,
            f"start {series.start}")


def _says(chosen):
    """The cheapest run for each of some errors, over all paths."""
    labels = names.scheme_names(series.scheme for _, series in chosen)
    said = []
    for source, target in (("local", "local equation"), ("nonlocal", "nonlocal model")):
        runs = [(seconds, error, f"{labels[series.scheme]}, {names.path_text(series.path)}, N = {N}")
                for _, series in chosen if series.source == source
                for seconds, error, N in zip(*_points([series.cases]))]
        picks = work_precision.cheapest(runs)
        if picks:
            found = [f"{min(errors):g} in {seconds:.2g} s ({what})"
                     for (seconds, _, what), errors in picks.items()]
            said.append(f"Cheapest for an error against the {target} of at most {'; '.join(found)}.")
    return " ".join(said)
