"""The same findings of several runs side by side, as `acstudy compare` matches them.

Results only: verdicts are those of the result files.
"""

from dataclasses import dataclass
import math

import numpy as np

# What has become of a finding, worst first.
WORSENED, IMPROVED, VERDICT, MISSING, NUMBERS, SAME = "worsened", "improved", "verdict", "missing", "numbers", "same"
CHANGES = (WORSENED, IMPROVED, VERDICT, MISSING, NUMBERS, SAME)


@dataclass(frozen=True)
class Line:
    """A finding in every run, None where a run has none."""
    study: str
    subject: str
    check: str
    findings: tuple
    change: str
    errors: tuple       # (lowest, highest) ratio of an error or a value, last run to first; NaN: none
    pairs: float        # ratio of work, last to first, of a series; NaN: none
    seconds: float      # the same of run times


def lines(runs):
    """Every finding that a run has. runs: the studies of each, oldest first."""
    found = {}
    for i, studies in enumerate(runs):
        for study in studies:
            for finding in study.findings:
                found.setdefault((study.name, *_identity(finding)), {})[i] = finding
    asked = [{study.name for study in studies} for studies in runs]
    return [_line(name, [by_run.get(i) for i in range(len(runs))], sum(name in names for names in asked))
            for (name, *_), by_run in found.items()]


def _identity(finding):
    """By what a finding is known in its study: the theorem that speaks of a series says nothing of what is run."""
    conditions = tuple(sorted((name, str(value)) for name, value in finding.coordinates.items())) or finding.check
    return finding.subject, "" if finding.series else finding.statement, conditions


def _line(study, findings, asked):
    """asked: how many runs have the study."""
    there = [finding for finding in findings if finding is not None]
    first, last = there[0], there[-1]
    return Line(study, last.subject, last.check, tuple(findings), _change(findings, asked),
                _ratios(first, last), _total(first, last, "work_pairs"), _total(first, last, "seconds"))


def _change(findings, asked):
    last = findings[-1]
    there = [finding for finding in findings if finding is not None]
    if last is not None:
        # A loosened expectation does not hide that a verdict got worse.
        if any(one.as_expected and not (last.as_expected and _meets(last.verdict, one)) for one in there):
            return WORSENED
        if last.as_expected and not all(one.as_expected for one in there):
            return IMPROVED
    if len({one.verdict for one in there}) > 1:
        return VERDICT
    if len(there) < asked:
        return MISSING
    return SAME if all(_same(there[0], one) for one in there) else NUMBERS


def _meets(verdict, finding):
    """Whether a verdict is what the study of a finding expects."""
    return (verdict in (finding.expected, *finding.also_expected)
            or (finding.expected, verdict) == ("confirmed", "pre-asymptotic")
            or finding.expected == "stable" and verdict != "unstable")


def _same(one, other):
    """Whether all values are equal to the last bit, and the orders that were observed."""
    return _same_points(one, other) and all(map(_equal, _numbers(one), _numbers(other)))


def _numbers(finding):
    """The numbers that do not differ from run to run."""
    cases = finding.series.cases if finding.series else None
    return [finding.points.value, (finding.observed_order, finding.observed_low, finding.observed_high),
            *(getattr(cases, name, None) for name in ("error_l1", "error_l2", "work_pairs"))]


def _equal(some, others):
    return some is others or (some is not None and others is not None and np.array_equal(some, others, equal_nan=True))


def _same_points(one, other):
    """Whether the values of both are of the same points, but for round-off."""
    return (len(one.points) == len(other.points) and one.points.label == other.points.label and
            all(np.allclose(getattr(one.points, name), getattr(other.points, name), rtol=1e-12, atol=0, equal_nan=True)
                for name in ("N", "h", "delta", "variable")))


def _ratios(first, last):
    none = (math.nan, math.nan)
    if not _same_points(first, last):
        return none
    before, after = first.points.value, last.points.value
    with np.errstate(all="ignore"):
        found = np.where(before == after, 1.0, after / before)
    found = found[np.isfinite(found) & (found > 0)]
    return (found.min(), found.max()) if found.size else none


def _total(first, last, name):
    if not (first.series and last.series and _same_points(first, last)):
        return math.nan
    before, after = (getattr(finding.series.cases, name).sum() for finding in (first, last))
    return after / before if before > 0 else math.nan
