"""The page of a report: what was claimed, what was observed, and everything needed to doubt it.

One HTML file without scripts; it reads the figures beside it and nothing from a network.
"""

from html import escape
import math
from pathlib import Path
from urllib.parse import quote

import names

STYLE = (Path(__file__).parent / "page.css").read_text(encoding="utf-8")

ABOUT = """A nonlocal discretization has two lengths: the horizon <var>δ</var>, up to which particles interact, and
the spacing <var>h</var> of the particles. It is <em>asymptotically compatible</em> (AC) when its solution converges to
that of the local equation however <var>δ</var> and <var>h</var> shrink to zero, in whatever relation to each other,
and to that of the nonlocal model when <var>h</var> alone does. Each series below refines one scheme along one path
<var>δ</var>(<var>h</var>); its order is fitted to the max-norm errors against a manufactured exact solution at the
final time and judged against the order that theory gives."""

# How a verdict is to be read; its badge also carries its name, so that color is never the only sign.
KINDS = {"confirmed": "good", "pre-asymptotic": "near", "floor": "fair", "inconclusive": "fair"}

CASE_COLUMNS = ("<var>N</var>", "<var>h</var>", "<var>δ</var>", "Δ<var>t</var>", "steps", "max-norm error",
                "pairwise order", "run time (s)", "fastest – slowest", "repeats", "pairs", "weight builds",
                "quadrature points")


def html(studies, figures, cost):
    """The page as text. `figures`: names of the studies that have a figure; `cost`: whether there is a cost figure."""
    body = [_summary(studies)]
    body += [_study(study, study.name in figures) for study in studies]
    if cost:
        body.append(_cost())
    links = "".join(f'<a href="#{study.name}">{study.name}</a>' for study in studies)
    links += '<a href="#run-time">run time</a>' if cost else ""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Asymptotic compatibility: convergence studies</title>
<style>
{STYLE}</style>
</head>
<body>
<header>
<h1>Asymptotic compatibility: convergence studies</h1>
<p>{ABOUT}</p>
<nav aria-label="Studies">{links}</nav>
</header>
<main>
{"".join(body)}</main>
</body>
</html>
"""


# ------------------------------------------------------------------------------------------------------- the summary

def _summary(studies):
    every = [series for study in studies for series in study.series]
    departing = sum(not series.as_expected for series in every)
    kind, said = ("bad", f"{departing} of {len(every)} series not as expected.") if departing else (
        "good", f"All {len(every)} series are as expected." if every else "No series has been run.")
    rows = "".join(_summary_row(study, series, labels[series.scheme])
                   for study in studies for labels in [_labels(study)] for series in study.series)
    columns = ("study", "scheme", "path", "theory's order", "observed order", "95 % interval", "verdict", "as expected")
    return (f'<section aria-labelledby="summary">\n<h2 id="summary">Claims and verdicts</h2>\n'
            f'<p class="outcome {kind}">{said}</p>\n{_table(columns, rows, "Claims and verdicts")}</section>\n')


def _summary_row(study, series, label):
    theory = (f"{names.order(series.theory_order, '{:g}')} in {_variable(series.theory_variable)}"
              f' <span class="note">{escape(series.theory_statement)}</span>')
    interval = f"[{names.order(series.observed_low)}, {names.order(series.observed_high)}]"
    return (f'<tr{_departs(series)}><td><a href="#{study.name}">{study.name}</a></td>'
            f'<th scope="row">{escape(label)}</th><td>{escape(series.path)}</td><td class="theory">{theory}</td>'
            f'<td class="number">{names.order(series.observed_order)}</td><td class="number">{interval}</td>'
            f"<td>{_badge(series)}</td><td>{_expected(series)}</td></tr>\n")


def _departs(series):
    return "" if series.as_expected else ' class="departs"'


def _badge(series):
    # A failure that the study expects (a negative control) is no alarm.
    kind = KINDS.get(series.verdict, "control" if series.as_expected else "bad")
    return f'<span class="badge {kind}">{escape(series.verdict)}</span>'


def _expected(series):
    return "yes" if series.as_expected else f"<strong>no</strong>, expected {escape(series.expected)}"


# ------------------------------------------------------------------------------------------------- a study, a series

def _study(study, has_figure):
    labels = _labels(study)
    paths = ", ".join(dict.fromkeys(series.path for series in study.series))
    alt = (f"Log-log plot of the max-norm error at the final time for {study.title}; paths: {paths}. "
           "Values: tables below.")
    parts = [f'<section aria-labelledby="{study.name}">\n<h2 id="{study.name}">{escape(study.title)} '
             f'<span class="note">{study.name}</span></h2>\n']
    if not study.series:
        parts.append("<p>No series has been run.</p>\n")
    if has_figure:
        parts.append(_figure(study.name, alt, "Error of each scheme along each path; the thin line has theory's slope. "
                             "Brackets: 95 % interval of the fitted order. Numbers above a panel: particles N."))
    parts += [_series(series, labels[series.scheme]) for series in study.series]
    scene = {"name": study.scene.name, "period": f"{study.scene.period:.10g}", "T": f"{study.scene.T:.10g}",
             "advection velocity c": study.scene.c,
             "particle velocity b": study.scene.b or "none: particles stand still",
             "exact solution u": study.scene.u, "flow": study.scene.flow or "none given"}
    text = f'<pre tabindex="0">{escape(study.text)}</pre>\n' if study.text else ""
    parts.append(f"<details><summary>Scene and study file</summary>\n{_list(scene)}{text}</details>\n")
    parts.append(f"<details><summary>Provenance</summary>\n{_list(study.provenance)}</details>\n</section>\n")
    return "".join(parts)


def _series(series, label):
    cases, statement = series.cases, escape(series.theory_statement)
    rows = []
    for i in range(len(cases)):
        cells = (f"{cases.N[i]}", _value(cases.h[i]), _value(cases.delta[i]), _value(cases.dt[i]),
                 _count(cases.steps[i]), _error(cases.error_linf[i]),
                 names.order(cases.pairwise[i - 1]) if i else "", _seconds(cases.seconds[i]),
                 f"{_seconds(cases.seconds_low[i])} – {_seconds(cases.seconds_high[i])}",
                 _count(cases.repeats[i]), _count(cases.work_pairs[i]), _count(cases.work_weight_builds[i]),
                 _count(cases.work_quadrature_points[i]))
        rows.append("<tr>" + "".join(f'<td class="number">{cell}</td>' for cell in cells) + "</tr>\n")
    observed = (f"order {names.order(series.observed_order)} "
                f"[{names.order(series.observed_low)}, {names.order(series.observed_high)}]")
    if math.isfinite(series.fitted_order):
        observed += f", by a power law alone {names.order(series.fitted_order)}"
    departs = "" if series.as_expected else f' <strong class="warning">expected {escape(series.expected)}</strong>'
    details = [f"{series.scheme.kernel} kernel", f"{series.source} source", series.integrator,
               f"step at most {series.step_text}"]
    if series.scheme.alpha is not None:
        details.insert(1, f"α = {series.scheme.alpha:.6g}")
    if series.scheme.mu is not None:
        details.append(f"μ = {series.scheme.mu:.6g}")
    theory = f"order {names.order(series.theory_order, '{:g}')} in {_variable(series.theory_variable)} ({statement})"
    return (f"<article{_departs(series)}>\n"
            f"<h3>{escape(label)}; {escape(series.path)} {_badge(series)}{departs}</h3>\n"
            f'<p>Theory: {theory}. Observed: {observed}.</p>\n<p class="reason">{escape(series.reason)}</p>\n'
            f'<p class="note">{escape(", ".join(details))}</p>\n'
            f"{_table(CASE_COLUMNS, ''.join(rows), f'{label}; {series.path}', numbers=True)}</article>\n")


def _cost():
    return ('<section aria-labelledby="run-time">\n<h2 id="run-time">Error against run time</h2>\n'
            + _figure("cost", "Log-log plot of the max-norm error against the run time of every scheme, "
                      "a panel per path. Values: tables above.",
                      "Run time of the whole time loop: median of the repeats, bars from the fastest to the slowest. "
                      "Comparable only between runs of one machine. Series run by several studies are drawn once.")
            + "</section>\n")


# ---------------------------------------------------------------------------------------------------- parts of a page

def _figure(stem, alt, caption):
    stem = quote(stem)
    return (f'<figure>\n<div class="card" tabindex="0"><img src="{stem}.svg" alt="{escape(alt)}"></div>\n'
            f'<figcaption>{escape(caption)} <a href="{stem}.svg">SVG</a> <a href="{stem}.png">PNG</a></figcaption>\n'
            "</figure>\n")


def _table(columns, rows, label, numbers=False):
    kind = ' class="number"' if numbers else ""
    heads = "".join(f'<th scope="col"{kind}>{column}</th>' for column in columns)
    return (f'<div class="scroll" role="region" tabindex="0" aria-label="{escape(label)}">\n<table>\n'
            f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n</div>\n")


def _list(entries):
    return ("<dl>\n" + "".join(f"<dt>{escape(key)}</dt><dd>{escape(value)}</dd>\n" for key, value in entries.items())
            + "</dl>\n")


def _labels(study):
    return names.scheme_names(series.scheme for series in study.series)


def _variable(variable):
    return {"h": "<var>h</var>", "max(h,delta)": "max(<var>h</var>, <var>δ</var>)"}.get(variable, escape(variable))


# ------------------------------------------------------------------------------------------------------------ numbers

def _value(number):
    return f"{number:.4g}" if math.isfinite(number) else str(number)


def _error(number):
    return f"{number:.3e}" if math.isfinite(number) else f'<strong class="warning">{number}</strong>'


def _seconds(number):
    return f"{number:.3g}" if math.isfinite(number) else "–"


def _count(number):
    """Groups of three digits apart by a narrow space, as tables of large numbers are set."""
    return f"{number:,}".replace(",", "\u202f")
