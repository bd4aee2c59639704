"""What a reader asks, in the order of the page, and which study answers: the one place that says so.

A study goes to the first question that takes it, by its kind and its statements; so do those that users write.
"""

from dataclasses import dataclass
import re
from typing import Callable

from kinds import registry


@dataclass(frozen=True)
class Question:
    """A part of the page."""
    anchor: str
    title: str
    asks: str           # the question in a sentence
    takes: Callable     # (study) -> whether it answers this question; studies that came before are gone


def _series_of_theorems(study):
    return study.kind == "convergence" and bool(study.findings) and all(
        finding.statement.startswith("Theorem") for finding in study.findings)


FIGURES = Question(
    "figures", "The paper's figures", "Do both models converge as in figures 1 to 5 of the paper?",
    lambda study: study.kind == "convergence" and re.fullmatch(r"fig[1-9]\d*", study.name))
COMPATIBILITY = Question(
    "compatibility", "Asymptotic compatibility", "Does the error vanish however horizon and spacing shrink?",
    lambda study: study.kind == "map")
THEOREMS = Question(
    "theorems", "Theorem by theorem", "Does each theorem hold with other scenes, kernels and particles?",
    lambda study: _series_of_theorems(study) and not study.steps_in_several_ways)
LEMMAS = Question(
    "lemmas", "Lemma by lemma", "Do the operators do what the lemmas say, at any ratio of horizon to spacing?",
    lambda study: study.kind in ("consistency", "identities"))
RUN_TIME = Question(
    "run-time", "Error against run time", "How long does it take to be how accurate, and what should one choose?",
    lambda study: False)
STABILITY = Question(
    "stability", "Stability and stiff scenes", "Which steps are stable, and do stiff scenes run?",
    lambda study: study.kind in ("stability", "stability-map") or study.steps_in_several_ways)
EXTREMES = Question(
    "extremes", "Extremes", "What happens at the ends of every range, and do weights keep their digits?",
    lambda study: study.kind in ("extremes", "digits"))
MISTAKES = Question(
    "mistakes", "Would a mistake be seen?", "Which check notices a wrong scheme, and what does a missing part do?",
    lambda study: study.kind == "controls")
JUDGE = Question(
    "judge", "The judge's own tests", "Are verdicts and intervals right where the truth is known?",
    lambda study: study.kind in ("corpus", "coverage", "scan", "pollution"))
FURTHER = Question("further", "Further studies", "What came out of studies beside these questions?", lambda study: True)

ALL = (FIGURES, COMPATIBILITY, THEOREMS, LEMMAS, RUN_TIME, STABILITY, EXTREMES, MISTAKES, JUDGE, FURTHER)


def by_question(studies):
    """{question: its studies}, in the order of the page; those of one question in the order of `studies`."""
    found = {question: [] for question in ALL}
    for study in studies:
        found[next(question for question in ALL if question.takes(study))].append(study)
    return found


def of_statement(statement):
    """The question that a statement of the paper belongs to."""
    return THEOREMS if statement.name.startswith("Theorem") else LEMMAS


def judged(studies):
    """(entries of the ledger, noun) of studies: what their verdicts are about."""
    nouns = list(dict.fromkeys(registry.of(study).noun for study in studies))
    return [entry for study in studies for entry in registry.entries(study)], " and ".join(nouns)
