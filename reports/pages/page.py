"""The page of a report: what was claimed, what was observed, and everything needed to doubt it."""

from html import escape
import math

from pages import bench as bench_page, claims, comparison, mutants
from kinds import extremes_table, stepping
from reading import ledger, names
from writing import markup, tables
from kinds.stability_map import table as stability_map_table
from reading.results import CONVERGENCE

TITLE = "Asymptotic compatibility: convergence studies"
ABOUT = """A nonlocal discretization has two lengths: the horizon <var>δ</var>, up to which particles interact, and
the spacing <var>h</var> of the particles. It is <em>asymptotically compatible</em> (AC) when its solution converges to
that of the local equation however <var>δ</var> and <var>h</var> shrink to zero, in whatever relation to each other,
and to that of the nonlocal model when <var>h</var> alone does. Each series below refines one scheme along one path
<var>δ</var>(<var>h</var>) and measures the max-norm error against a manufactured exact solution at the final time. The
observed order is the order in the limit: that of a power law with a correction, fitted to the errors of all levels of
the window, with its 95 % interval; with three levels it is that of a power law alone. Beside it stands the slope of a
power law alone, which a correction bends. The verdict judges both against the order that theory gives."""

TIMED = f'<p><a href="{bench_page.FILE}">Measured so that they can be compared</a>: each case alone, repeatedly, in turn.</p>\n'
UNTIMED = "<p><code>make bench</code> measures them so that they can be compared: alone, repeatedly, in turn.</p>\n"

CASE_COLUMNS = ("<var>N</var>", "<var>h</var>", "<var>δ</var>", "Δ<var>t</var>", "steps", "max-norm error",
                "pairwise order", "run time (s)", "fastest – slowest", "repeats", "pairs", "weight builds",
                "quadrature points")


def html(studies, drawings, cost=None, seeded=None, compared=None, timed=False):
    """The page as text.

    `drawings`: {name of a study: its drawings}; `cost`: the drawing of the cost figure; `seeded`: mutants.read();
    `compared`: comparison.read(); `timed`: there is a page of benches.
    """
    body = [_summary(studies)]
    for study in studies:
        part = _convergence if study.kind == CONVERGENCE else _findings
        body.append(part(study, drawings.get(study.name, [])))
    if cost:
        body.append('<section aria-labelledby="run-time">\n<h2 id="run-time">Error against run time</h2>\n'
                    f"{markup.figure(cost)}{TIMED if timed else UNTIMED}</section>\n")
    body.append(comparison.section(compared))
    body.append(mutants.section(seeded))
    links = [("claims.html", "claim by claim")]
    links += [(bench_page.FILE, "error against run time")] if timed else []
    links += [(f"#{study.name}", study.name) for study in studies]
    links += [("#run-time", "run time")] if cost else []
    links.append(("#comparison", "other programs"))
    links.append(("#seeded-mistakes", "seeded mistakes"))
    return markup.document(TITLE, ABOUT, links, "".join(body))


# ------------------------------------------------------------------------------------------------------- the summary

def _summary(studies):
    series = [one for study in studies if study.kind == CONVERGENCE for one in study.series]
    found = [one for study in studies if study.kind != CONVERGENCE for one in study.findings]
    judged = {"series": series, "findings": found}
    said = markup.outcome({noun: sum(not one.as_expected for one in group) for noun, group in judged.items()},
                   {noun: len(group) for noun, group in judged.items()})
    rows = "".join(_summary_row(study, one, labels[one.scheme]) for study in studies
                   if study.kind == CONVERGENCE and not study.steps_in_several_ways
                   for labels in [_labels(study)] for one in study.series)
    columns = ("study", "scheme", "path", "theory's order", "observed order", "95 % interval",
               "by a power law alone", "verdict", "as expected")
    parts = [f'<section aria-labelledby="summary">\n<h2 id="summary">Claims and verdicts</h2>\n{said}',
             '<p><a href="claims.html">Claim by claim</a>: every statement of the paper with the worst that was '
             "measured of it.</p>\n"]
    stepped = [study for study in studies if study.steps_in_several_ways]
    if rows or not (found or stepped):
        parts.append(markup.table(columns, rows, "Claims and verdicts"))
    if stepped:
        parts.append("<p>Run with several integrators and steps:</p>\n")
        parts.append(markup.table(("study", "", "series", "blow up", "as expected"), "".join(map(_stepped_row, stepped)),
                                  "Studies run with several integrators and steps"))
    if found:
        rows = "".join(_findings_row(study) for study in studies if study.kind != CONVERGENCE)
        parts.append("<p>Judged by findings:</p>\n")
        parts.append(markup.table(("study", "", "statements", "findings", "negative controls", "as expected"), rows,
                           "Studies judged by findings"))
    return "".join(parts) + "</section>\n"


def _findings_row(study):
    departing = sum(not finding.as_expected for finding in study.findings)
    statements = ", ".join(dict.fromkeys(finding.statement for finding in study.findings))
    said = f"<strong>{departing} not</strong>" if departing else "all"
    return (f'<tr{markup.departs_if(departing)}>'
            f'<td><a href="#{study.name}">{study.name}</a></td><th scope="row">{escape(study.title)}</th>'
            f'<td class="said">{escape(statements)}</td><td class="number">{len(study.findings)}</td>'
            f'<td class="number">{sum(finding.control for finding in study.findings)}</td><td>{said}</td></tr>\n')


def _stepped_row(study):
    departing = sum(not series.as_expected for series in study.series)
    said = f"<strong>{departing} not</strong>" if departing else "all"
    return (f'<tr{markup.departs_if(departing)}>'
            f'<td><a href="#{study.name}">{study.name}</a></td><th scope="row">{escape(study.title)}</th>'
            f'<td class="number">{len(study.series)}</td>'
            f'<td class="number">{sum(series.verdict == "unstable" for series in study.series)}</td>'
            f"<td>{said}</td></tr>\n")


def _summary_row(study, series, label):
    theory = (f"{names.order(series.theory_order, '{:g}')} in {markup.variable(series.theory_variable)}"
              f' <span class="note">{escape(series.theory_statement)}</span>')
    interval = f"[{names.order(series.observed_low)}, {names.order(series.observed_high)}]"
    return (f'<tr{markup.departs(series)}><td><a href="#{study.name}">{study.name}</a></td>'
            f'<th scope="row">{escape(label)}</th><td>{escape(series.path)}</td><td class="theory">{theory}</td>'
            f'<td class="number">{names.order(series.observed_order)}</td><td class="number">{interval}</td>'
            f'<td class="number">{names.order(series.fitted_order)}</td>'
            f"<td>{markup.badge(series)}</td><td>{markup.expected(series)}</td></tr>\n")


# ------------------------------------------------------------------------------------------------- a study, a series

def _convergence(study, drawings):
    labels = _labels(study)
    parts = [_heading(study)]
    if not study.series:
        parts.append("<p>No series has been run.</p>\n")
    parts += [markup.figure(drawing) for drawing in drawings]
    every = [_series(series, labels[series.scheme]) for series in study.series]
    if study.steps_in_several_ways:
        parts.append(stepping.table(study))
        every = ["<details><summary>Every series</summary>\n", *every, "</details>\n"]
    return "".join((*parts, *every)) + _origin(study)


def _findings(study, drawings):
    """A study that is judged by its findings; those that depart are not folded away."""
    every = ledger.entries(study)
    departing = [entry for entry in every if not entry.as_expected]
    parts = [_heading(study), markup.outcome({"findings": len(departing)}, {"findings": len(every)})]
    if study.kind == "extremes":
        parts.append(extremes_table.table(study, every))
    parts += [markup.figure(drawing) for drawing in drawings]
    if departing and study.kind != "corpus":
        parts.append(tables.entry_table(departing, f"{study.title}: not as expected"))
    if study.kind == "stability-map":
        parts.append(stability_map_table.html(study))
    if study.kind == "corpus":
        parts.append(claims.corpus_table(study))
    elif study.kind == "extremes":
        parts.append(extremes_table.every_finding(study, every))
    elif every:
        parts.append(f"<details><summary>Every finding</summary>\n{tables.entry_table(every, study.title)}</details>\n")
    return "".join(parts) + _origin(study)


def _heading(study):
    return (f'<section aria-labelledby="{study.name}">\n<h2 id="{study.name}">{escape(study.title)} '
            f'<span class="note">{study.name}</span></h2>\n')


def _origin(study):
    """What the study asked for and what made its numbers; ends its section."""
    scene = {} if study.scene is None else {
        "name": study.scene.name, "period": f"{study.scene.period:.10g}", "T": f"{study.scene.T:.10g}",
        "advection velocity c": study.scene.c, "particle velocity b": study.scene.b or "none: particles stand still",
        **({"exact solution u": study.scene.u} if study.scene.u else
           {"initial values u0": study.scene.u0, "source f": study.scene.f or "0"}), "flow": study.scene.flow or "none given"}
    text = f'<pre tabindex="0">{escape(study.text)}</pre>\n' if study.text else ""
    asked = "Scene and study file" if scene else "Study file"
    return (f"<details><summary>{asked}</summary>\n{markup.listing(scene)}{text}</details>\n"
            f"<details><summary>Provenance</summary>\n{markup.listing(study.provenance)}</details>\n</section>\n")


def _series(series, label):
    cases, statement = series.cases, escape(series.theory_statement)
    rows = []
    for i in range(len(cases)):
        cells = (f"{cases.N[i]}", markup.value(cases.h[i]), markup.value(cases.delta[i]), markup.value(cases.dt[i]),
                 markup.count(cases.steps[i]), markup.error(cases.error_linf[i]),
                 names.order(cases.pairwise[i - 1]) if i else "", markup.seconds(cases.seconds[i]),
                 f"{markup.seconds(cases.seconds_low[i])} – {markup.seconds(cases.seconds_high[i])}",
                 *map(markup.count, (cases.repeats[i], cases.work_pairs[i], cases.work_weight_builds[i],
                                     cases.work_quadrature_points[i])))
        rows.append("<tr>" + "".join(f'<td class="number">{cell}</td>' for cell in cells) + "</tr>\n")
    observed = (f"order {names.order(series.observed_order)} "
                f"[{names.order(series.observed_low)}, {names.order(series.observed_high)}]")
    if math.isfinite(series.fitted_order):
        observed += f", by a power law alone {names.order(series.fitted_order)}"
    departs = "" if series.as_expected else f' <strong class="warning">expected {escape(series.expected)}</strong>'
    details = [f"{series.scheme.kernel} kernel", f"{series.source} source", series.integrator,
               f"step at most {series.step_text}"]
    if series.start != "uniform":
        details.append(f"start {series.start}")
    if series.scheme.alpha is not None:
        details.insert(1, f"α = {series.scheme.alpha:.6g}")
    if series.scheme.mu is not None:
        details.append(f"μ = {series.scheme.mu:.6g}")
    variable = markup.variable(series.theory_variable)
    theory = f"order {names.order(series.theory_order, '{:g}')} in {variable} ({statement})"
    return (f"<article{markup.departs(series)}>\n"
            f"<h3>{escape(label)}; {escape(series.path)} {markup.badge(series)}{departs}</h3>\n"
            f'<p>Theory: {theory}. Observed: {observed}.</p>\n<p class="reason">{escape(series.reason)}</p>\n'
            f'<p class="note">{escape(", ".join(details))}</p>\n'
            f"{markup.table(CASE_COLUMNS, ''.join(rows), f'{label}; {series.path}', numbers=True)}</article>\n")


def _labels(study):
    return names.scheme_names(series.scheme for series in study.series)
