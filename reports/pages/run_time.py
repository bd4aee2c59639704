"""Error against run time: a figure for each scene, what to choose for a wanted error, and what benches measured."""

import numpy as np
from markupsafe import Markup

from kinds import registry, run_times
from kinds.bench import tables as bench_tables
from pages import comparison
from pages.study import listing
from reading import names, work_precision
from reading.bench_results import Curve, Spread
from writing import figures, markup, tables

ALONE = Markup("""<p>Each case was run alone and repeatedly, after a run that does not count, in turn with all others, so
that a disturbance of the machine meets all alike. A time is the median of its runs; all runs are in
<code>bench.h5</code> and <code>bench.json</code>. Seconds are those of one machine; the work beside them is not.</p>
""")
BESIDE = Markup("""<p>Seconds are those of the studies themselves, which share particles and machine: they say what is quick
and what is slow. <code>make bench</code> measures them so that they can be compared: alone, repeatedly, in turn.</p>
""")


def curves(studies, benches):
    """The curves whose errors and times are compared: those of benches, else those of studies."""
    measured = [curve for curve in bench_tables.compared(benches) if len(curve)]
    return measured or [_curve(study, series, scene)
                        for scene, group in run_times.scenes(registry.with_run_times(studies)).items()
                        for study, series in run_times.cost_curves(group) if len(series.cases)]


def section(curves_found, costs, benches, of_benches, compared):
    """The part of the page. `costs`: drawings, one for each scene; `of_benches`: those of benches."""
    parts = [ALONE if benches else BESIDE]
    if curves_found:
        parts.append(choices(curves_found))
    parts += map(figures.figure, [*of_benches, *costs])
    if benches:
        found = [(title, header, rows, text.replace("`", "")) for title, header, rows, text in
                 bench_tables.page_tables(benches)]
    else:
        found = [("Seconds to reach an error", *bench_tables.reach_table(curves_found),
                  bench_tables.REACH_NOTE.replace("`", ""))] if curves_found else []
    for title, header, rows, text in found:
        table = tables.table(title, [f"~{header[0]}", *header[1:]], rows)
        parts.append(tables.fold(title, markup.joined((table, Markup("<p>{}</p>\n").format(markup.note(text))))))
    parts += [tables.fold(f"Provenance of {bench.file.parent.name}", _origin(bench)) for bench in benches]
    parts += [Markup('<h3 id="q.comparison">Other programs on the same cases</h3>\n'), comparison.section(compared)]
    return markup.joined(parts)


def choices(found):
    """What to choose for a wanted error: the quickest scheme along each path of each scene."""
    scenes, groups = list(dict.fromkeys(curve.scene for curve in found)), {}
    for curve in sorted(found, key=lambda curve: scenes.index(curve.scene)):
        groups.setdefault((curve.scene, curve.path), []).append(curve)
    targets = map(work_precision.target_text, work_precision.TARGETS)
    rows = [(scene, path, *(_quickest(group, target) for target in work_precision.TARGETS))
            for (scene, path), group in groups.items()]
    several = len({scene for scene, *_ in rows}) > 1
    columns = ("scene", "path", *(f"~error of {target}" for target in targets))
    return tables.table("What to choose for a wanted error: the quickest scheme along each path",
                        columns if several else columns[1:], rows if several else [row[1:] for row in rows])


def _quickest(group, target):
    reached = [(reach.seconds, reach.kind, i) for i, curve in enumerate(group)
               if (reach := work_precision.reach(curve, target)).kind in ("between", "coarsest", "beyond")]
    if not reached:
        return "not reached"
    seconds, kind, i = min(reached)
    return Markup("{} {}").format(_REACHED[kind].format(bench_tables.seconds(seconds)),
                                  markup.note(names.full_name(group[i].scheme)))


_REACHED = {"between": "{} s", "coarsest": "< {} s", "beyond": "~ {} s, extrapolated"}


def _curve(study, series, scene):
    """A series as a curve of a bench. scene: its name."""
    cases = series.cases
    n = len(cases)
    spread = Spread(np.where(cases.seconds > 0, cases.seconds, np.nan), cases.seconds_low,
                    np.maximum(cases.seconds_high - cases.seconds, 0.0))
    return Curve((study.name,), study.title, series.scheme, series.path, series.source, series.delta_text, series.step_text,
                 series.integrator, series.stepping, "", scene, study.scene.T, 1, cases.N,
                 cases.h, cases.delta, cases.steps, np.ones(n), cases.error_linf, spread, {}, cases.work_pairs,
                 cases.repeats)


def _origin(bench):
    said = {"samples of a case": f"at least {bench.runs}, of at least {bench.least_seconds:g} s in all",
            "finished": "yes" if bench.complete else "no: some cases have fewer samples"}
    return listing({**said, **bench.provenance})
