"""Studies that step in several ways: error against run time, explicit beside implicit, and what each way came to."""

import math

from markupsafe import Markup
from matplotlib.lines import Line2D
import numpy as np

from drawing import axes, hover
from drawing.look import COLORS, DASHES, GRAY, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from drawing.timed import error_over_seconds
from kinds.kind import Kind
from reading import names
from writing import figures, markup, tables
from writing.series import cases_fold, labeled, series_table, steps_taken

COLUMNS = ("scheme", "path", "~steps", "came to be", "as expected", Markup("#<var>N</var>"), "#max-norm error",
           "#run time (s)", "#steps taken", "#longest / bound", "~beyond it from", "~given up at")


def drawings(study, styles):
    panels = {}
    for result in study.findings:
        panels.setdefault((result.series.path, result.series.scheme), []).append(result)
    return [Drawing(
        study.name, study.title, run_time_figure(panels),
        f"Log-log plots of the max-norm error against run time for {study.title}, a curve per integrator and rule of "
        "steps. Values: table below.",
        "Error against the run time of the whole time loop, from coarse to fine N; bars from the fastest to the slowest "
        "repeat. Lower left is better. Crosses at the upper edge: runs that blew up, at the time they took to do so.",
        says=_says(study))]


def _only_bounded(found):
    """Whether nothing is asked for but that solutions stay bounded, or that they do not."""
    return all(result.expected in ("stable", "unstable") for result in found)


def _says(study):
    """How many ways stay bounded, and the cheapest of the best errors."""
    lost = sum(result.verdict == "unstable" for result in study.findings)
    right = sum(result.as_expected for result in study.findings)
    said = (f"{len(study.findings) - lost} of {markup.several(len(study.findings), 'series')} stay bounded, {lost} blow "
            f"up; {'all' if right == len(study.findings) else right} as expected.")
    if _only_bounded(study.findings):
        said += " No convergence is expected here: the claim is that solutions stay bounded."
    return said


def run_time_figure(panels):
    """A row per path, a column per scheme, a curve per way to step."""
    with typography():
        every = [result for group in panels.values() for result in group]
        paths = list(dict.fromkeys(path for path, _ in panels))
        schemes = list(dict.fromkeys(scheme for _, scheme in panels))
        ways = list(dict.fromkeys(result.series.stepping for result in every))
        labels = names.scheme_names(schemes)
        left, right, gap, above, between = 0.85, 0.1, 0.16, 0.5, 0.3
        foot = 0.75 + math.ceil(len(ways) / 2) * LINE * 1.6
        width = min(4.0, (WIDTH - left - right - (len(schemes) - 1) * gap) / len(schemes))
        tall = 2.4
        figure = blank(above + len(paths) * tall + (len(paths) - 1) * between + foot)
        cases_of_all = [result.series.cases for result in every]
        drawn = [axes.drawable(cases.seconds, cases.error_linf) for cases in cases_of_all]
        times = axes.padded(np.concatenate([cases.seconds[cases.seconds > 0] for cases in cases_of_all]))
        errors = axes.padded(np.concatenate([y[np.isfinite(y)] for _, y in drawn]))
        # Room at the upper edge for the runs that blew up.
        errors = errors[0], errors[1] * (errors[1] / errors[0]) ** 0.1
        for i, path in enumerate(paths):
            bottom = figure.get_figheight() - above - (i + 1) * tall - i * between
            for k, scheme in enumerate(schemes):
                if (path, scheme) not in panels:
                    continue
                panel = add_axes(figure, left + k * (width + gap), bottom, width, tall, xscale="log", yscale="log")
                for result in panels[path, scheme]:
                    _draw(panel, result, ways.index(result.series.stepping))
                axes.set_log_limits(panel, times, errors, (width, tall))
                last = i == len(paths) - 1
                panel.tick_params(top=True, right=True, labelleft=k == 0, labelbottom=last)
                if i == 0:
                    panel.set_title(labels[scheme], fontsize=11, pad=20)
                panel.annotate(names.path_math(path), (0, 1), xycoords="axes fraction", xytext=(0, 4),
                               textcoords="offset points", va="bottom", fontsize=10.5)
                if last:
                    panel.set_xlabel("run time (s)")
                if k == 0:
                    panel.set_ylabel("max-norm error at $T$")
        keys = [Line2D([], [], **_style(i)) for i in range(len(ways))]
        key = foot_legend(figure, left, keys, [names.literal(_said(way, every)) for way in ways], 2)
        hover.mark_legend(key, ways)
        if _only_bounded(every):
            figure.text((WIDTH - right) / WIDTH, 0.12 / figure.get_figheight(),
                        "stable: the solution stays bounded;\nits error is not expected to fall", ha="right", va="bottom",
                        fontsize=9.5, color=GRAY)
        return figure


def _said(way, every):
    """A way to step, and whether every run of it blew up."""
    verdicts = {result.verdict for result in every if result.series.stepping == way}
    finite = any(np.isfinite(result.series.cases.error_linf).any() for result in every if result.series.stepping == way)
    return f"{way}: blows up" if verdicts == {"unstable"} and not finite else way


def _style(i):
    color = COLORS[i % len(COLORS)]
    return dict(color=color, marker=MARKERS[i % len(MARKERS)], linestyle=DASHES[i % len(DASHES)], markersize=4.6,
                markerfacecolor=color if i % 2 == 0 else "none")


def _draw(panel, result, i):
    series, cases = result.series, result.series.cases
    error_over_seconds(panel, cases, name=series.stepping, about=f"{series.path}: {result.verdict}", **_style(i))
    lost = ~np.isfinite(cases.error_linf) & (cases.seconds > 0)
    crosses, = panel.plot(cases.seconds[lost], np.full(lost.sum(), 0.975), linestyle="none", marker="x", markersize=6,
                          color=_style(i)["color"], transform=panel.get_xaxis_transform())
    hover.mark(crosses, series.stepping, f"{series.path}: blew up", N=cases.N[lost], seconds=cases.seconds[lost])


def table(study):
    """A row per series: what its finest run came to."""
    return tables.table(f"{study.title}: what each way to step came to", COLUMNS,
                        [_row(result, label) for result, label in labeled(study) if len(result.series.cases)])


def _row(result, label):
    series, cases = result.series, result.series.cases
    beyond = np.flatnonzero(cases.bound_first_step > 0)
    lost = np.flatnonzero(np.isfinite(cases.last_time))
    bound = f"{np.max(cases.bound_largest):.3g}" if np.max(cases.bound_largest) > 0 else "–"
    where = given_up = "–"
    if len(beyond):
        i = beyond[-1]
        where = Markup("step {:.0f}, <var>t</var> = {:.3g}, <var>x</var> = {:.4g}").format(
            cases.bound_first_step[i], cases.bound_first_time[i], cases.bound_first_place[i])
    if len(lost):
        i = lost[-1]
        given_up = Markup("step {:.0f} of <var>N</var> = {}, <var>t</var> = {:.3g}, <var>x</var> = {:.4g}").format(
            cases.last_step[i], cases.N[i], cases.last_time[i], cases.last_place[i])
    return tables.Row((label, series.path, series.stepping, _came_to_be(result), markup.expected(result),
                       f"{cases.N[-1]}", markup.error(cases.error_linf[-1]), markup.seconds(cases.seconds[-1]),
                       steps_taken(cases, -1), bound, where, given_up), not result.as_expected)


def _came_to_be(result):
    """The verdict; where nothing but stability was asked for, that it is stable."""
    if result.expected == "stable" and result.as_expected:
        return markup.tag("stable", "good")
    return markup.badge(result, result.expected == "unstable")


def _section(study, drawings, entries):
    departing = sum(not result.as_expected for result in study.findings)
    every = tables.fold(Markup('Every series <span class="note">{}</span>').format(len(study.findings)),
                        series_table(study), kind="findings")
    return markup.joined((markup.outcome({"series": departing}, {"series": len(study.findings)}),
                          *map(figures.figure, drawings), table(study), every, cases_fold(study)))


KIND = Kind(drawings, _section, noun="series")
