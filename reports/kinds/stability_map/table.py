"""The table of a stability map: sharp limits beside the bound that the lemma prints and what the rows need."""

from markupsafe import Markup
import numpy as np

from writing import markup, tables
from kinds.stability_map.findings import NORM, SEARCH_END, SPECTRAL, lemma, lemma_suffices, of_kind, parts

COLUMNS = ("scheme", "particles", "integrator", "~printed bound", "~rows' bound", "~sharp limit, max norm",
           "~sharp limit, spectral radius", "verdict", "as expected")
_NONE = f"none up to {SEARCH_END:g}"


def html(study):
    """A row per scheme, arrangement of the particles and integrator; "" for a study without limits."""
    limits = {}
    for kind in (NORM, SPECTRAL):
        for finding in of_kind(study, kind):
            arrangement, integrator = parts(finding)
            limits.setdefault((finding.subject, arrangement, integrator), {})[kind] = finding
    if not limits:
        return ""
    exact = any(_exact(finding) for found in limits.values() for finding in found.values())
    rows = [_row(key, found) for key, found in limits.items()]
    departing = any(row.departs for row in rows)
    said = Markup('Sharp limits <span class="note">{}: scheme, particles, integrator</span>').format(len(rows))
    return tables.fold(said, markup.joined((_about(exact), tables.table(f"{study.title}: sharp limits", COLUMNS, rows))),
                       departing, kind="findings")


def _about(exact):
    said = ("CFL numbers: Δ<var>t</var> over the longest step that the lemma prints. The rows' bound, which is "
            "sufficient, is the least over <var>δ</var>/<var>h</var>; limits are the least and the largest over "
            "<var>δ</var>/<var>h</var>, by bisection, of the CFL numbers up to which no step grows beyond "
            "φ(<var>C</var>Δ<var>t</var>), φ the stability function of the integrator, 1 for constant velocities; an "
            f"implicit step has to stay below the pole of φ. The search ends at {SEARCH_END:g}.")
    if exact:
        said += " Exact: theory says that the rows' bound is the limit, and the bisection agrees to 1e−6."
    return Markup(f"<p>{said}</p>\n")


def _row(key, found):
    either = list(found.values())
    judged = next((one for one in either if not one.as_expected), either[0])
    return tables.Row((*key, _printed(found.get(NORM)), _rows_bound(either[0]),
                       *(_limit(found.get(kind)) for kind in (NORM, SPECTRAL)), markup.badge(judged, judged.control),
                       markup.expected(judged)), not judged.as_expected)


def _printed(finding):
    """Whether what the lemma prints is enough for the norm; not said of a control."""
    if finding is None or finding.control:
        return "1"
    if lemma_suffices(finding):
        return Markup("1 {}").format(markup.note(f"{lemma(finding)} suffices"))
    return Markup('1 <strong class="warning">{} does not suffice</strong>').format(lemma(finding))


def _rows_bound(finding):
    lower = finding.points.lower
    least = np.min(lower) if len(lower) else np.nan
    if least >= 0.99 * SEARCH_END:
        return _NONE
    if np.isnan(least) or np.isneginf(least):
        return "–"
    if least <= 0:
        return "none promised"
    note = "exact" if _exact(finding) else "of the scheme that it is taken for" if finding.control else ""
    return Markup("{} {}").format(markup.value(least), markup.note(note)) if note else markup.value(least)


def _exact(finding):
    """Whether theory names the limit from both sides and it lies there."""
    points = finding.points
    return bool(np.all(np.isfinite(points.upper) & (points.lower <= points.value) & (points.value <= points.upper)))


def _limit(finding):
    """ "1.2 – 4.7", the extremes in words where they are no numbers."""
    if finding is None:
        return "–"
    values = finding.points.value
    if np.isnan(values).any():
        return Markup('<strong class="warning">nan</strong>')
    ends = [_said(value) for value in (values.min(), values.max())]
    return " – ".join(dict.fromkeys(ends))


def _said(value):
    if value >= SEARCH_END:
        return _NONE
    return markup.value(value) if value > 0 else "0: no step is stable"

