"""What the second screen says: the headline figure in numbers, and what every seeded mistake does to it."""

import math

from markupsafe import Markup

from pages import questions
from reading import names
from writing import markup, tables
from writing.series import interval, labeled

IN_NUMBERS = ("scheme", "~path", "#order in the limit [95 %]", "#theory", "verdict", Markup("#finest <var>N</var>"),
              "#error there", "#seconds there")
NOTICED = ("~what is wrong", "~what it does", "#alarms", "~noticed by")


def study_of(found):
    """The study of the headline figure: of the paper's figures, else of theorems, the one with most series; or None."""
    for question in (questions.FIGURES, questions.THEOREMS):
        if found[question]:
            return max(found[question], key=lambda study: len(study.findings))
    return None


def reading(study):
    """The figure in a sentence."""
    orders = [result for result in study.findings if math.isfinite(result.observed_order) and result.theory_order > 0]
    paths = len({result.series.path for result in study.findings})
    schemes = len({result.series.scheme for result in study.findings})
    said = (f"{markup.several(schemes, 'scheme')} along {markup.several(paths, 'path')} "
            "on which horizon and spacing shrink. ")
    if orders:
        low, high = (names.order(end(result.observed_order for result in orders)) for end in (min, max))
        theory = " and ".join(sorted({f"{result.theory_order:g}" for result in orders}))
        said += (f"Every curve falls with an order between {low} and {high}; theory says {theory}. " if len(orders) > 1
                 else f"The error falls with the order {low}; theory says {theory}. ")
    departing = sum(not result.as_expected for result in study.findings)
    return said + (f"{departing} of {len(study.findings)} series are not as expected." if departing else
                   "No series departs from what is expected.")


def in_numbers(study):
    """The series of the headline figure: the order and how sure it is, the finest error and what it cost."""
    rows = []
    for result, label in labeled(study):
        cases = result.series.cases
        finest = ((f"{cases.N[-1]}", markup.error(cases.error_linf[-1]), markup.seconds(cases.seconds[-1]))
                  if len(cases) else ("–",) * 3)
        rows.append(tables.Row((label, result.series.path, interval(result), names.order(result.theory_order, "{:g}"),
                                markup.badge(result), *finest), not result.as_expected))
    return tables.table(f"{study.title}, in numbers", IN_NUMBERS, rows)


def noticed(study):
    """Of a study of kind "controls": each wrong scheme, what it does, and the checks that notice it."""
    rows = []
    for subject in dict.fromkeys(finding.subject for finding in study.findings if finding.control):
        of_subject = [finding for finding in study.findings if finding.subject == subject]
        checks = [finding for finding in of_subject if finding.check != "alarms"]
        alarms = [finding for finding in checks if finding.alarm]
        remark = next((finding.remark for finding in of_subject if finding.remark), "")
        rows.append(tables.Row((subject, remark, f"{len(alarms)} of {len(checks)}", _by(alarms) or "nothing"),
                               not all(finding.as_expected for finding in of_subject)))
    return tables.table(f"{study.title}: wrong schemes", NOTICED, rows)


def _by(alarms):
    """"step norm: violated; delta = h^2: stagnates"."""
    by = {}
    for finding in alarms:
        by.setdefault(finding.verdict, []).append(finding.check)
    return "; ".join(f"{verdict}: {', '.join(checks)}" for verdict, checks in by.items())
