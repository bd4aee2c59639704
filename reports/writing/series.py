"""Series as text: each with all of its cases."""

from html import escape
import math

from reading import names
from writing import markup

CASE_COLUMNS = ("<var>N</var>", "<var>h</var>", "<var>δ</var>", "Δ<var>t</var>", "steps", "max-norm error",
                "pairwise order", "run time (s)", "fastest – slowest", "repeats", "pairs", "weight builds",
                "quadrature points")


def labeled(study):
    """(finding, name of its scheme), each name as short as tells the schemes of the study apart."""
    labels = names.scheme_names(result.series.scheme for result in study.findings)
    return [(result, labels[result.series.scheme]) for result in study.findings]


def article(result, label):
    """All of a series: theory and what was observed, how it was run, a row per case."""
    series, cases, statement = result.series, result.series.cases, escape(result.series.theory_statement)
    rows = []
    for i in range(len(cases)):
        cells = (f"{cases.N[i]}", markup.value(cases.h[i]), markup.value(cases.delta[i]), markup.value(cases.dt[i]),
                 markup.count(cases.steps[i]), markup.error(cases.error_linf[i]),
                 names.order(cases.pairwise[i - 1]) if i else "", markup.seconds(cases.seconds[i]),
                 f"{markup.seconds(cases.seconds_low[i])} – {markup.seconds(cases.seconds_high[i])}",
                 *map(markup.count, (cases.repeats[i], cases.work_pairs[i], cases.work_weight_builds[i],
                                     cases.work_quadrature_points[i])))
        rows.append("<tr>" + "".join(f'<td class="number">{cell}</td>' for cell in cells) + "</tr>\n")
    observed = (f"order {names.order(result.observed_order)} "
                f"[{names.order(result.observed_low)}, {names.order(result.observed_high)}]")
    if math.isfinite(series.observed_fitted):
        observed += f", by a power law alone {names.order(series.observed_fitted)}"
    departs = "" if result.as_expected else f' <strong class="warning">expected {escape(result.expected)}</strong>'
    details = [f"{series.scheme.kernel} kernel", f"{series.source} source", series.integrator,
               f"step at most {series.step_text}"]
    if series.start != "uniform":
        details.append(f"start {series.start}")
    if series.scheme.alpha is not None:
        details.insert(1, f"α = {series.scheme.alpha:.6g}")
    if series.scheme.mu is not None:
        details.append(f"μ = {series.scheme.mu:.6g}")
    variable = markup.variable(result.variable_name)
    theory = f"order {names.order(result.theory_order, '{:g}')} in {variable} ({statement})"
    return (f"<article{markup.departs(result)}>\n"
            f"<h3>{escape(label)}; {escape(series.path)} {markup.badge(result)}{departs}</h3>\n"
            f'<p>Theory: {theory}. Observed: {observed}.</p>\n<p class="reason">{escape(result.reason)}</p>\n'
            f'<p class="note">{escape(", ".join(details))}</p>\n'
            f"{markup.table(CASE_COLUMNS, ''.join(rows), f'{label}; {series.path}', numbers=True)}</article>\n")
