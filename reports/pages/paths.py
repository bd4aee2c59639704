"""Asymptotic compatibility path by path: the orders of every scheme, whichever study ran it."""

import math

from markupsafe import Markup

from kinds import registry
from reading import names
from writing import markup, tables
from writing.series import interval

ABOUT = Markup("""<p>The order of the error in max(<var>h</var>, <var>δ</var>) along each path on which both vanish, against
the local equation, with its 95&nbsp;% interval. A scheme is asymptotically compatible if it converges on all of them.</p>
""")


def table(studies):
    """A row per scheme, a column per path; "" without series on such paths."""
    found, paths = {}, {}
    for study in studies:
        if not registry.of(study).run_times:
            continue
        for result in study.findings:
            if result.variable_name == "max(h,delta)" and result.theory_order > 0 and math.isfinite(result.observed_order):
                paths[result.series.path] = None
                cells = found.setdefault(names.full_name(result.series.scheme), {})
                cells.setdefault(result.series.path, []).append((result, study))
    if not found:
        return ""
    rows = [tables.Row((scheme, *(_cell(cells.get(path, ())) for path in paths)),
                       any(not result.as_expected for group in cells.values() for result, _ in group))
            for scheme, cells in sorted(found.items())]
    return markup.joined((ABOUT, tables.table("Orders of every scheme along every path", (
        "scheme", *(f"~{names.path_text(path)}" for path in paths)), rows)))


def _cell(group):
    return markup.joined((Markup("{} {}").format(interval(result), markup.link(study.name, study.name))
                          for result, study in group), markup.BAR) or "–"
