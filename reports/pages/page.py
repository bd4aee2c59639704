"""The page of a report: what was claimed, what was observed, and everything needed to doubt it."""

from html import escape

from kinds import registry
from pages import bench as bench_page, comparison, mutants
from writing import markup

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


def html(studies, drawings, cost=(), seeded=None, compared=None, timed=False):
    """The page as text.

    `drawings`: {name of a study: its drawings}; `cost`: the drawings of error against run time; `seeded`: mutants.read();
    `compared`: comparison.read(); `timed`: there is a page of benches.
    """
    body = [_summary(studies)]
    for study in studies:
        shown = registry.of(study).section(study, drawings.get(study.name, []), registry.entries(study))
        body.append(f"{_heading(study)}{shown}{_origin(study)}")
    if cost:
        body.append('<section aria-labelledby="run-time">\n<h2 id="run-time">Error against run time</h2>\n'
                    f"{''.join(map(markup.figure, cost))}{TIMED if timed else UNTIMED}</section>\n")
    body.append(comparison.section(compared))
    body.append(mutants.section(seeded))
    links = [("claims.html", "claim by claim")]
    links += [(bench_page.FILE, "error against run time")] if timed else []
    links += [(f"#{study.name}", study.name) for study in studies]
    links += [("#run-time", "run time")] if cost else []
    links.append(("#comparison", "other programs"))
    links.append(("#seeded-mistakes", "seeded mistakes"))
    return markup.document(TITLE, ABOUT, links, "".join(body))


def _summary(studies):
    """The first sentence, and a table for each way in which kinds of study are summed up."""
    judged = {summary.noun: [] for summary in registry.SUMMARIES}
    of = {summary: [] for summary in registry.SUMMARIES}
    for study in studies:
        summary = registry.of(study).summary
        judged[summary.noun] += study.findings
        of[summary].append(study)
    said = markup.outcome({noun: sum(not one.as_expected for one in group) for noun, group in judged.items()},
                          {noun: len(group) for noun, group in judged.items()})
    parts = [f'<section aria-labelledby="summary">\n<h2 id="summary">Claims and verdicts</h2>\n{said}',
             '<p><a href="claims.html">Claim by claim</a>: every statement of the paper with the worst that was '
             "measured of it.</p>\n"]
    for summary, group in of.items():
        rows = "".join(map(summary.rows, group))
        if rows:
            parts.append(f"{summary.introduction}{markup.table(summary.columns, rows, summary.label)}")
    return "".join(parts) + "</section>\n"


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
