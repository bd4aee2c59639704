"""The ledger: every statement of theory with what was measured of it, in the order of the paper.

Results only: nothing here judges. Verdicts, intervals and reasons are those of the result files.
"""

from dataclasses import dataclass
import math
import re

import numpy as np

from reading import names

# The statements of the paper in its order.
PAPER = ("(2.3)", "Remark 2.1", "Remark 2.2", "Lemma 2.3", "Lemma 2.4", "Lemma 2.5", "Theorem 2.6", "Theorem 2.7",
         "Theorem 2.8", "Lemma 3.1", "(3.4)", "(3.5)", "Lemma 3.2", "Lemma 3.3", "Lemma 3.4", "Theorem 3.5",
         "Theorem 3.6", "Theorem 3.7")
# From best to worst, where each is as expected.
_SEVERITY = ("holds", "confirmed", "pre-asymptotic", "floor", "inconclusive")


@dataclass(frozen=True)
class Entry:
    """A finding as one line of the ledger."""
    study: object
    finding: object
    statement: str
    claim: str
    subject: str
    check: str
    measured: str       # "order 0.97 [0.95, 1.01]", or the value nearest to its bound
    order: float        # NaN: no order was asked for
    margin: float       # distance of the worst value to its bound, relative to the bound; negative beyond; NaN: none
    verdict: str
    expected: str
    as_expected: bool
    control: bool       # must fail, because the statement does not apply
    refuted: bool       # the statement, as printed, is not true here, and the study expects that
    unsharp: bool       # a bound that it states is not attained here, and the study expects that
    reason: str
    remark: str


@dataclass(frozen=True)
class Statement:
    """A statement of the paper with every entry about it."""
    name: str
    entries: tuple

    @property
    def claims(self):
        return tuple(dict.fromkeys(entry.claim for entry in self.entries))

    @property
    def tested(self):
        """The entries in which the statement has to hold."""
        return tuple(entry for entry in self.entries if not entry.control and not entry.unsharp)

    @property
    def controls(self):
        return tuple(entry for entry in self.entries if entry.control)

    @property
    def refuted(self):
        """The entries that show that the statement, as printed, is not true."""
        return tuple(entry for entry in self.entries if entry.refuted)

    @property
    def unsharp(self):
        return tuple(entry for entry in self.entries if entry.unsharp)

    @property
    def departing(self):
        return tuple(entry for entry in self.entries if not entry.as_expected)

    @property
    def worst(self):
        """The entry that decides the verdict: one that departs, else the least certain; None without entries."""
        return max(self.tested or self.entries, key=_badness, default=None)


def statements(entries):
    """(statements of the paper in its order, further statements in order of appearance).

    Values that theory does not bound are for the record.
    """
    found = {}
    for entry in entries:
        if entry.finding.promised != "inconclusive":
            found.setdefault(entry.statement, []).append(entry)
    all_of_them = [Statement(name, tuple(group)) for name, group in found.items()]
    of_paper = [statement for statement in all_of_them if _base(statement.name) in PAPER]
    of_paper.sort(key=lambda statement: (PAPER.index(_base(statement.name)), statement.name))
    return of_paper, [statement for statement in all_of_them if statement not in of_paper]


def entries(study, disputes=False):
    """What a study says, a line for each finding.

    disputes: it expects something else than a statement of the paper promises only where it disputes the statement:
    its truth, or, where errors should grow with a bound, that the bound is attained.
    """
    return [_entry(study, finding, disputes and finding.expected != finding.promised) for finding in study.findings]


def _entry(study, finding, disputed):
    i, margin = closest(finding.points)
    unsharp = finding.promised == "diverges"
    return Entry(study, finding, finding.statement, finding.claim, finding.subject, finding.check, measured(finding, i),
                 math.nan if finding.promised == "stable" else finding.observed_order,
                 margin if i is not None and finding.test == "bounds" else math.nan,
                 finding.verdict, " or ".join((finding.expected, *finding.also_expected)), finding.as_expected,
                 finding.control and not disputed, disputed and not unsharp, disputed and unsharp, finding.reason,
                 finding.remark)


def measured(finding, i=None):
    """What was observed, in a few words. `i`: of closest(), if it is known."""
    if math.isfinite(finding.observed_order):
        return order_text(finding)
    if finding.series:
        return "no order"
    i = closest(finding.points)[0] if i is None else i
    if i is None or finding.test != "bounds":
        return "–"
    points = finding.points
    value, lower, upper = _apart(points.value[i], points.lower[i], points.upper[i])
    if math.isinf(points.lower[i]):
        if value == upper != "0":
            value, upper = (_beside(float(f"{points.upper[i]:.6g}"), one) for one in (points.value[i], points.upper[i]))
        return f"{value} ≤ {upper}" if points.value[i] <= points.upper[i] else f"{value} > {upper}"
    if math.isinf(points.upper[i]):
        return f"{value} ≥ {lower}" if points.value[i] >= points.lower[i] else f"{value} < {lower}"
    if lower == upper and points.lower[i] < points.upper[i]:
        middle, half = (points.lower[i] + points.upper[i]) / 2, (points.upper[i] - points.lower[i]) / 2
        deviation = abs(points.value[i] - middle)
        return f"|value − {middle:g}| = {deviation:.2g} {'≤' if deviation <= half else '>'} {half:.2g}"
    inside = points.lower[i] <= points.value[i] <= points.upper[i]
    return f"{value} {'in' if inside else 'outside'} [{lower}, {upper}]"


def _apart(*numbers):
    """The numbers with three digits, or as many more, up to six, as tell them apart."""
    different = len(set(numbers))
    texts = next((texts for digits in (3, 4, 5) if len(set(texts := [f"{one:.{digits}g}" for one in numbers])) == different),
                 [f"{one:.6g}" for one in numbers])
    return [text.replace("-", "−") for text in texts]


def _beside(round_number, value):
    """A value that differs from a round number by next to nothing: "1 + 2.2e−16"."""
    if value == round_number or not math.isfinite(value):
        return f"{round_number:.6g}"
    sign = "+" if value > round_number else "−"
    return f"{round_number:.6g} {sign} {abs(value - round_number):.2g}".replace("e-", "e−")


def order_text(result):
    return (f"order {names.order(result.observed_order)} "
            f"[{names.order(result.observed_low)}, {names.order(result.observed_high)}]")


def closest(points):
    """(index, margin) of the value nearest to its bound or farthest beyond; (None, NaN) where nothing is bounded.

    The margin is the distance to the bound relative to the larger bound, negative beyond it.
    """
    if not len(points):
        return None, math.nan
    with np.errstate(invalid="ignore"):
        bound = np.maximum(_finite_size(points.lower), _finite_size(points.upper))
        margin = np.minimum(points.upper - points.value, points.value - points.lower) / np.where(bound > 0, bound, 1.0)
    margin[np.isnan(margin)] = -np.inf      # what is not a number keeps no bound
    i = int(np.argmin(margin))
    return (None, math.nan) if margin[i] == np.inf else (i, float(margin[i]))


def _finite_size(bounds):
    return np.where(np.isfinite(bounds), np.abs(bounds), 0.0)


def _base(statement):
    found = re.match(r"(?:Lemma|Remark|Theorem) \d\.\d+|\(\d\.\d+\)", statement)
    return found.group() if found else statement


def _badness(entry):
    severity = _SEVERITY.index(entry.verdict) if entry.verdict in _SEVERITY else len(_SEVERITY)
    margin = entry.margin if not math.isnan(entry.margin) else math.inf
    order = entry.order if math.isfinite(entry.order) else math.inf
    return not entry.as_expected, entry.refuted, severity, -margin, -order
