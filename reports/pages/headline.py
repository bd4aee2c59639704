"""What the second screen says: the headline figure in numbers, and what every seeded mistake does to it."""

import math

from markupsafe import Markup

from kinds.controls import COUNT, SHORT
from pages import questions
from reading import names
from writing import markup, tables
from writing.series import interval, labeled

SHORT_WORDS = "; ".join(f"{short} {word}" for word, short in SHORT.items())


def study_of(found):
    """The study of the headline figure: of the paper's figures, else of theorems, the one with most series; or None."""
    for question in (questions.FIGURES, questions.THEOREMS):
        if found[question]:
            return max(found[question], key=lambda study: len(study.findings))
    return None


def reading(study, said):
    """The figure in a sentence. `said`: it says itself what came out."""
    orders = [result for result in study.findings if math.isfinite(result.observed_order) and result.theory_order > 0]
    paths = len({result.series.path for result in study.findings})
    schemes = len({result.series.scheme for result in study.findings})
    both = all(result.variable_name == "max(h,delta)" for result in study.findings)
    said_of = (f"{markup.several(schemes, 'scheme')} along {markup.several(paths, 'path')}"
               f"{' on which horizon and spacing shrink' if both else ''}. ")
    if said:
        return said_of
    if orders:
        low, high = (names.order(end(result.observed_order for result in orders)) for end in (min, max))
        theory = " and ".join(sorted({f"{result.theory_order:g}" for result in orders}))
        said_of += (f"Every curve falls with an order between {low} and {high}; theory says {theory}. " if len(orders) > 1
                    else f"The error falls with the order {low}; theory says {theory}. ")
    departing = sum(not result.as_expected for result in study.findings)
    return said_of + (f"{departing} of {len(study.findings)} series are not as expected." if departing else
                      "No series departs from what is expected.")


def in_numbers(study):
    """A row per scheme, a column per path: the order and how sure it is, the finest error and what it cost."""
    paths = list(dict.fromkeys(result.series.path for result in study.findings))
    cells = {}
    for result, label in labeled(study):
        cells.setdefault(label, {}).setdefault(result.series.path, []).append(result)
    rows = [tables.Row((label, *(markup.joined(map(_cell, of_scheme.get(path, ())), markup.BAR) or "–" for path in paths)),
                       any(not result.as_expected for group in of_scheme.values() for result in group))
            for label, of_scheme in cells.items()]
    return tables.table(f"{study.title}, in numbers", ("scheme", *(names.path_text(path) for path in paths)), rows)


def _cell(result):
    cases = result.series.cases
    finest = (f"error {cases.error_linf[-1]:.1e} at N = {cases.N[-1]} in {markup.seconds(cases.seconds[-1])} s".replace(
        "e-0", "e−") if len(cases) else "")
    return Markup("<strong>{}</strong>, theory {} {}<br>{}").format(
        interval(result), names.order(result.theory_order, "{:g}"), markup.badge(result), markup.note(finest))


def noticed(study):
    """Of a study of kind "controls": a row per wrong scheme, a column per check, with the verdict where it notices."""
    wrong = [finding for finding in study.findings if finding.check != COUNT]
    subjects = dict.fromkeys(finding.subject for finding in study.findings if finding.control)
    checks = list(dict.fromkeys(finding.check for finding in wrong))
    remarks = {finding.subject: finding.remark for finding in study.findings if finding.check == COUNT}
    cells = {(finding.subject, finding.check): finding for finding in wrong}
    rows = []
    for subject in subjects:
        found = [cells.get((subject, check)) for check in checks]
        name, _, scheme = subject.rstrip(")").partition(" (")
        rows.append(tables.Row((
            Markup("<strong>{}</strong> {}").format(name, markup.note(remarks.get(subject, ""))), scheme.replace(" divergence", ""),
            *map(_alarm, found)), not all(finding.as_expected for finding in found if finding)))
    columns = ("what is wrong", "in", *(f"|{names.path_text(check)}" for check in checks))
    return tables.table(f"{study.title}: wrong schemes", columns, rows)


def _alarm(finding):
    """What a check says of a scheme where it notices something; what departs stands out."""
    if finding is None:
        return "–"
    if not finding.alarm:
        return "" if finding.as_expected else Markup("<strong>quiet</strong>")
    return Markup('<span class="alarm{}" title="{}">{}</span>').format(
        "" if finding.as_expected else " bad", finding.verdict, SHORT.get(finding.verdict, finding.verdict))
