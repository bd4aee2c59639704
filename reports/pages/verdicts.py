"""The first screen: does everything hold, question by question, with a number and a small picture for each."""

from collections import Counter
from dataclasses import dataclass
import math

from kinds import registry
from pages import questions
from reading import names, work_precision
from writing import markup, sparks


@dataclass(frozen=True)
class Verdict:
    """What came out of a question. kind: "good", "bad", or "" where there is nothing to hold."""
    question: questions.Question
    kind: str
    said: str
    picture: str


def verdicts(found, curves, seeded, statements):
    """A verdict for each question with results. `found`: of questions.by_question(); `curves`: of pages.run_time;
    `seeded`: mutants.read(); `statements`: of the paper."""
    rows = []
    for question, studies in found.items():
        if question is questions.RUN_TIME and curves:
            rows.append(_of_run_time(curves))
        elif question is questions.MISTAKES and (studies or seeded):
            rows.append(_of_mistakes(studies, seeded or ()))
        elif studies:
            rows.append(_of_studies(question, studies, [one for one in statements
                                                        if questions.of_statement(one) is question]))
    return rows


def departing(studies):
    """The entries that depart, of all studies."""
    return [entry for study in studies for entry in registry.entries(study) if not entry.as_expected]


def _of_studies(question, studies, statements):
    entries, noun = questions.judged(studies)
    bad = sum(not entry.as_expected for entry in entries)
    said = f"{bad} of {len(entries)} {noun} not as expected" if bad else f"all {len(entries)} {noun} as expected"
    if statements:
        said = f"{markup.several(len(statements), 'statement')}; {said}"
    tested = [entry.finding for entry in entries if not entry.control and not entry.refuted and not entry.unsharp]
    orders = [(one.observed_order, one.theory_order) for one in tested
              if one.theory_order > 0 and math.isfinite(one.observed_order) and one.promised == "confirmed"]
    held = [registry.of(study).held_to(study) for study in studies if registry.of(study).held_to]
    picture = sparks.shares(_parts(entries))
    if orders and 2 * len(orders) > len(entries):
        values = [order for order, _ in orders]
        theory = sorted({f"{theory:g}" for _, theory in orders})
        said += (f"; orders {names.order(min(values))} to {names.order(max(values))}, theory's {' and '.join(theory)}")
        picture = sparks.ratios([order / theory for order, theory in orders])
    elif held:
        said += f"; {held[0].rstrip('.')}"
    else:
        said += _beside(entries)
    return Verdict(question, "bad" if bad else "good", said, picture)


def _beside(entries):
    """What of the entries is no plain evidence."""
    counts = {"show a statement not so as printed": sum(entry.refuted for entry in entries),
              "negative controls fail as they must": sum(entry.control and entry.as_expected for entry in entries)}
    return "".join(f"; {number} {what}" for what, number in counts.items() if number)


def _parts(entries):
    parts = {"good": 0, "near": 0, "control": 0, "bad": 0}
    for entry in entries:
        kind = ("bad" if not entry.as_expected else "near" if entry.refuted or entry.unsharp else
                "control" if entry.control else "good")
        parts[kind] += 1
    return parts


def _of_mistakes(studies, seeded):
    rows, good, said = [], True, []
    for study in studies:
        good &= all(finding.as_expected for finding in study.findings)
        said.append(registry.of(study).held_to(study).rstrip("."))
        alarms = {}
        for finding in study.findings:
            if finding.check != "alarms":
                alarms.setdefault(finding.subject, []).append(finding.alarm)
        rows += alarms.values()
    if seeded:
        mistakes = [one for one in seeded if not one.control]
        good &= all(one.as_expected for one in seeded)
        said.append(f"{sum(one.as_expected for one in mistakes)} of {len(mistakes)} mistakes seeded in the sources are "
                    "caught")
    return Verdict(questions.MISTAKES, "good" if good else "bad", "; ".join(said), sparks.matrix(rows))


def _of_run_time(curves):
    points = [(seconds, error) for curve in curves for seconds, error in zip(curve.seconds.median, curve.error)]
    efficient = work_precision.frontier(*zip(*points))
    # Against the equation, on the scene that most is known of.
    local = [curve for curve in curves if curve.source == "local"] or curves
    scene = Counter(curve.scene for curve in local).most_common(1)[0][0]
    target, seconds, curve = _quickest([curve for curve in local if curve.scene == scene])
    said = (f"an error of {target:.0e} in {seconds:.2g} s".replace("e-0", "e-") +
            f": {names.full_name(curve.scheme)}, {names.path_text(curve.path)}, on {scene}") if curve else (
                f"{len(points)} timed cases")
    return Verdict(questions.RUN_TIME, "", said, sparks.front(points, efficient))


def _quickest(curves):
    """(error, seconds, curve): the smallest of the usual errors that a curve reaches within its levels, the quickest."""
    for target in sorted(work_precision.TARGETS):
        found = [(reach.seconds, i) for i, curve in enumerate(curves)
                 if (reach := work_precision.reach(curve, target)).kind == "between"]
        if found:
            seconds, i = min(found)
            return target, seconds, curves[i]
    return None, math.nan, None
