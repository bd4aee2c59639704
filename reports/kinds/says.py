"""Sentences that say what to see in a figure of findings, made of the findings."""

import math

import numpy as np

from reading import ledger, names

SURE = 0.5      # width of the interval up to which an order counts as known


def verdicts(findings):
    """How many findings are as expected, and the first that is not: "All 12 findings are as expected"."""
    departing = [finding for finding in findings if not finding.as_expected]
    if departing:
        first = departing[0]
        return (f"{len(departing)} of {len(findings)} findings are not as expected, first {first.subject}, {first.check}: "
                f"{first.verdict}, expected {first.expected}")
    controls = sum(finding.control for finding in findings)
    among = f", among them {controls} negative controls, which must fail" if controls else ""
    return f"All {len(findings)} findings are as expected{among}"


def orders(findings):
    """Their verdicts, the range of the orders of those that must have one, and how sure the least certain is."""
    found = [finding for finding in findings if not finding.control and math.isfinite(finding.observed_order)]
    said = verdicts(findings)
    for theory in sorted({finding.theory_order for finding in found}):
        group = [finding for finding in found if finding.theory_order == theory]
        sure = [finding.observed_order for finding in group if _width(finding) <= SURE]
        at_least = "at least " if all(finding.test == "rate" for finding in group) else ""
        if sure:
            said += (f"; orders from {names.order(min(sure))} to {names.order(max(sure))}, theory "
                     f"{at_least}{names.order(theory, '{:g}')}")
        if len(sure) < len(group):
            worst = max(group, key=_width)
            said += (f"; {len(group) - len(sure)} of {len(group)} orders are known less well than to ±{SURE / 2:g}, the "
                     f"least within [{names.order(worst.observed_low)}, {names.order(worst.observed_high)}]")
    return f"{said}."


def _width(finding):
    width = finding.observed_high - finding.observed_low
    return width if math.isfinite(width) else math.inf


def bounds(findings):
    """Their verdicts, and which value comes closest to its bound of those that must keep one."""
    found = [finding for finding in findings if not finding.control and finding.test == "bounds"]
    closest = [(margin, finding) for finding in found
               if not math.isnan(margin := ledger.closest(finding.points)[1]) and math.isfinite(margin)]
    said = verdicts(findings)
    if closest:
        _, finding = min(closest, key=lambda pair: pair[0])
        said += f"; closest to its bound: {ledger.measured(finding)} ({finding.subject}, {finding.check})"
    return f"{said}."


def share(values, what):
    """ "Between 94 % and 96 % {what}." of shares; "" without any."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    return f"Between {100 * values.min():.1f} % and {100 * values.max():.1f} % {what}." if len(values) else ""
