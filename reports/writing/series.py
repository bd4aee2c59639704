"""Series as tables: a row for what came out of each, and a row for each of their cases."""

import math

import numpy as np
from markupsafe import Markup

from reading import names
from writing import markup
from writing.tables import Row, fold, table

SERIES = ("scheme", "~path", "~theory", "#observed order", "#by a power law alone", "verdict", "as expected",
          Markup("#finest <var>N</var>"), "#error there", "#seconds there", "?reason")
CASES = ("~series", Markup("#<var>N</var>"), Markup("#<var>h</var>"), Markup("#<var>δ</var>"), Markup("#Δ<var>t</var>"),
         "#steps", "#max-norm error", "#pairwise order", "#run time (s)", "#pairs", "#weight builds",
         "#quadrature points")


def labeled(study):
    """(finding, name of its scheme), each name as short as tells the schemes of the study apart."""
    labels = names.scheme_names(result.series.scheme for result in study.findings)
    return [(result, labels[result.series.scheme]) for result in study.findings]


def path_of(result):
    """The path of a series, with its integrator and steps where the study has several."""
    return "; ".join(filter(None, (result.series.path, result.series.stepping)))


def interval(result):
    """ "0.97 [0.95, 1.01]"."""
    return (f"{names.order(result.observed_order)} [{names.order(result.observed_low)}, "
            f"{names.order(result.observed_high)}]")


def series_table(study):
    """A row per series: what theory says, what was observed, what the finest case cost."""
    rows = []
    for result, label in labeled(study):
        cases = result.series.cases
        finest = ((f"{cases.N[-1]}", markup.error(cases.error_linf[-1]), markup.seconds(cases.seconds[-1])) if len(cases)
                  else ("–",) * 3)
        rows.append(Row((label, path_of(result), _theory(result), interval(result),
                         names.order(result.series.observed_fitted), markup.badge(result), markup.expected(result),
                         *finest, Markup("{} {}").format(result.reason, markup.note(how_run(result.series)))),
                        not result.as_expected))
    return table(f"{study.title}: series", SERIES, rows)


def _theory(result):
    order = names.order(result.theory_order, "{:g}")
    return Markup("{} in {} {}").format(order, markup.variable(result.variable_name),
                                        markup.note(result.series.theory_statement))


def how_run(series):
    """How a series was run, in a line."""
    if series.scheme.label:
        details = [f"{series.source} source", f"steps: {series.step_text}"]
    else:
        details = [f"{series.scheme.kernel} kernel", f"{series.source} source", series.integrator,
                   f"step {'' if series.step_text.startswith('adaptive') else 'at most '}{series.step_text}"]
    if series.start != "uniform":
        details.append(f"start {series.start}")
    if series.scheme.alpha is not None:
        details.insert(1, f"α = {series.scheme.alpha:.6g}")
    if series.scheme.mu is not None:
        details.append(f"μ = {series.scheme.mu:.6g}")
    return ", ".join(details)


def steps_taken(cases, i):
    """How many steps a case took, with those that were rejected where steps are adaptive."""
    if not cases.tolerance[i] > 0:
        return markup.count(cases.steps[i])
    return Markup("{} {}").format(markup.count(cases.steps[i]),
                                  markup.note(f"+ {markup.count(int(cases.rejected[i]))} rejected"))


def cases_fold(study):
    """Every case of a study with its order to the coarser neighbor, its run time and its work, folded away."""
    rows = [row for result, label in labeled(study) for row in _cases(result, label)]
    if not rows:
        return ""
    said = Markup('Every case <span class="note">{}</span>').format(markup.several(len(rows), "case"))
    return fold(said, table(f"{study.title}: cases", CASES, rows), kind="cases")


def _cases(result, label):
    cases = result.series.cases
    for i in range(len(cases)):
        spread = f"{markup.seconds(cases.seconds_low[i])} – {markup.seconds(cases.seconds_high[i])}"
        timed = Markup("{} {}").format(markup.seconds(cases.seconds[i]),
                                       markup.note(f"{spread}, {cases.repeats[i]} runs")
                                       if cases.repeats[i] > 1 and np.isfinite(cases.seconds[i]) else "")
        yield Row((f"{label}; {path_of(result)}", f"{cases.N[i]}", markup.value(cases.h[i]), markup.value(cases.delta[i]),
                   markup.value(cases.dt[i]), steps_taken(cases, i), markup.error(cases.error_linf[i]),
                   names.order(cases.pairwise[i - 1]) if i else "", timed,
                   *map(markup.count, (cases.work_pairs[i], cases.work_weight_builds[i],
                                       cases.work_quadrature_points[i]))), not math.isfinite(cases.error_linf[i])
                  and not result.as_expected)
