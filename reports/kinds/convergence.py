"""Convergence studies: the error of each scheme along each path against the theory's variable.

Nothing is fitted here; orders, intervals and verdicts are those of the result file.
"""

import math
import textwrap

from markupsafe import Markup
from matplotlib.lines import Line2D
import numpy as np

from drawing import axes, hover
from drawing.frames import panel_frames
from drawing.look import DEPARTING, GRAY, LEGEND, LINE, Drawing, foot_legend, typography
from drawing.timed import of_cases
from kinds.kind import Kind
from reading import names
from writing import figures, markup
from writing.series import cases_fold, series_table

COINCIDE = 0.01     # relative difference of errors below which two curves are said to lie on one another


def drawings(study, styles):
    """The figures of a convergence study."""
    figure = error_figure(study, styles)
    if figure is None:
        return []
    paths = ", ".join(dict.fromkeys(result.series.path for result in study.findings))
    against = "" if study.scene.u else (
        " Errors are differences to a finer run, whose own error is missing in them: curves bend down near it, and "
        "orders make up for it.")
    return [Drawing(
        study.name, study.title, figure,
        f"Log-log plot of the max-norm error at the final time for {study.title}; paths: {paths}. "
        "Values: tables below.",
        "Error of each scheme along each path; the thin line has theory's slope. Limit order: that of a power law "
        "with a correction, to which the order tends under refinement, with its 95 % interval; with three "
        "levels the order is that of a power law alone. Numbers above a panel: particles N; all panels span as many "
        "decades." + against, says=_says(study))]


def error_figure(study, styles):
    """Max-norm error at T against the theory's variable, a panel per path; None if the study has no series."""
    if not study.findings:
        return None
    with typography():
        panels = _by_path(study.findings)
        labels = names.scheme_names(result.series.scheme for result in study.findings)
        curves = [[_curve(result, styles[result.series.scheme]) for result in group] for group in panels.values()]
        several, room = len(panels) > 1, _legend_room(len(panels))
        legends = [[_legend_text(result, group[:i], labels, room, named=not several) for i, result in enumerate(group)]
                   for group in panels.values()]
        deepest = max(sum(LINE * (text.count("\n") + 1.6) for text in texts) for texts in legends)
        keys = {labels[scheme]: styles[scheme] for scheme in labels}
        foot = math.ceil(len(keys) / 2) * LINE * 1.6 + 0.15
        figure, frames = panel_frames(len(panels), above=0.54, below=deepest if several else 0,
                                      foot=foot if several else 0)
        limits = axes.equal_spans(list(map(axes.x_limits, curves)))
        bounds, references = axes.error_bounds(list(zip(curves, map(_orders, panels.values()))), frames[0].inches,
                                               limits)
        for frame, (path, group), drawn, lines, texts, span in zip(frames, panels.items(), curves, references, legends,
                                                                   limits):
            _error_panel(frame, path, group, drawn, (span, bounds), lines, labels)
            _legend(frame, group, drawn, texts, not several, labels)
            if frame.first:
                measured = "error" if study.scene.u else "difference to a finer run"
                frame.axes.set_ylabel(f"max-norm {measured} at $T = {study.scene.T:.4g}$")
        if several:
            key = foot_legend(figure, frames[0].left, [Line2D([], [], **style.line()) for style in keys.values()],
                              map(names.literal, keys), 2)
            hover.mark_legend(key, keys)
        return figure


def _error_panel(frame, path, group, curves, limits, references, labels):
    panel = frame.axes
    panel.set_title(names.path_math(path), pad=21)
    for (x, y, style), result in zip(curves, group):
        curve, = panel.plot(x, y, **style.line())
        hover.mark(curve, labels[result.series.scheme], _about(result), **of_cases(result.series.cases))
    axes.set_log_limits(panel, *limits, frame.inches)
    axes.name_levels(panel, [(result.series.cases.variable, result.series.cases.N) for result in group], frame.inches[0],
                     lead=frame.first)
    axes.draw_references(panel, references, frame.inches, GRAY)
    panel.tick_params(labelleft=frame.first)
    panel.set_xlabel(" or ".join(dict.fromkeys(names.variable_math(result.variable_name) for result in group)))


def _legend(frame, group, curves, texts, beside, labels):
    place = (1.04, 1.0) if beside else (0, -0.52 / frame.inches[1])
    legend = frame.axes.legend([Line2D([], [], **style.line()) for *_, style in curves], texts, loc="upper left",
                               bbox_to_anchor=place, **LEGEND)
    for text, result in zip(legend.get_texts(), group):
        text.set_color("black" if result.as_expected else DEPARTING)
        text.set_linespacing(1.12)
    hover.mark_legend(legend, [labels[result.series.scheme] for result in group])


def _about(result):
    """A series in a line, for who points at it."""
    interval = f"[{names.order(result.observed_low)}, {names.order(result.observed_high)}]"
    return (f"{result.series.path}; order {names.order(result.observed_order)} {interval}, theory "
            f"{names.order(result.theory_order, '{:g}')}: {result.verdict}")


def _curve(result, style):
    """(x, y, style); the curve breaks where a level cannot be drawn."""
    return *axes.drawable(result.series.cases.variable, result.series.cases.error_linf), style


def _orders(group):
    return sorted({result.theory_order for result in group if math.isfinite(result.theory_order)})


def _legend_room(panels):
    """Characters that fit into a line of the legend beside a single panel, or below one of several."""
    return 62 if panels in (2, 4) else 40


def _legend_text(result, before, labels, room, named):
    """`before`: the results of the panel that are drawn below this one; `named`: with the name of the scheme."""
    theory = names.order(result.theory_order, "{:g}")
    if math.isfinite(result.observed_order):
        interval = f"[{names.order(result.observed_low)}, {names.order(result.observed_high)}]"
        order = "limit order" if result.observed_order == result.extrapolated_order else "order"
        lines = [f"{order} {names.order(result.observed_order)} {interval}, theory {theory}"]
    else:
        lines = [f"order not available, theory {theory}"]
    if named:
        lines.insert(0, labels[result.series.scheme])
    if not result.as_expected:
        lines.append(f"{result.verdict}, expected {result.expected}")
    elif result.verdict != "confirmed":
        lines.append(result.verdict)
    errors = result.series.cases.error_linf
    for count, what in ((np.sum(~np.isfinite(errors)), "not finite"), (np.sum(errors == 0), "zero")):
        if count:
            lines.append(f"{count} of {len(errors)} levels {what}")
    for other in before:
        apart = _apart(errors, other.series.cases.error_linf)
        if apart < COINCIDE:
            lines += textwrap.wrap(f"within {100 * apart:.2g} % of {labels[other.series.scheme]}", room)
            break
    return "\n".join(names.literal(part) for line in lines for part in textwrap.wrap(line, room))


def _apart(errors, others):
    """The largest relative difference of the errors of two series; infinite where they are not of the same levels."""
    if len(errors) != len(others) or not len(errors) or not np.all(np.isfinite(errors) & (errors > 0)):
        return math.inf
    return float(np.max(np.abs(others / errors - 1)))


def _says(study):
    """How many series are as theory says, and where their orders lie."""
    found = study.findings
    right, theories = sum(result.as_expected for result in found), {result.theory_order for result in found}
    said = f"All {len(found)} series are as expected" if right == len(found) else (
        f"{len(found) - right} of {len(found)} series are not as expected")
    timely = [result for result in found if math.isfinite(result.observed_order)]
    if len(theories) > 1 or not timely:
        return said + "."
    orders = [result.observed_order for result in timely]
    least, most = min(one.observed_low for one in timely), max(one.observed_high for one in timely)
    return (f"{said}: orders between {names.order(min(orders))} and {names.order(max(orders))}, theory "
            f"{names.order(theories.pop(), '{:g}')}; all 95 % intervals lie within [{names.order(least)}, "
            f"{names.order(most)}].")


def _by_path(findings):
    panels = {}
    for one in findings:
        panels.setdefault(one.series.path, []).append(one)
    return panels


# ------------------------------------------------------------------------------------------------------- on the page

def _section(study, drawings, entries):
    if not study.findings:
        return markup.joined([Markup("<p>No series has been run.</p>\n")])
    departing = sum(not result.as_expected for result in study.findings)
    # Where all is as expected, the figure says so.
    outcome = markup.outcome({"series": departing}, {"series": len(study.findings)}) if departing or not drawings else ""
    return markup.joined((outcome, *map(figures.figure, drawings), series_table(study), cases_fold(study)))


KIND = Kind(drawings, _section, run_times=True, noun="series")
