"""The registry of kinds: a row for each, and what is asked of it."""

from functools import lru_cache

from drawing.styles import styles_of
from kinds import (consistency, controls, convergence, corpus, coverage, digits, error_map, extremes, identities,
                   pollution, scan, stability, stability_map, stepping)
from kinds.kind import Kind
from reading import ledger

KINDS = {
    "consistency": consistency.KIND,
    "controls": controls.KIND,
    "convergence": convergence.KIND,
    "corpus": corpus.KIND,
    "coverage": coverage.KIND,
    "digits": digits.KIND,
    "extremes": extremes.KIND,
    "identities": identities.KIND,
    "map": error_map.KIND,
    "pollution": pollution.KIND,
    "scan": scan.KIND,
    "stability": stability.KIND,
    "stability-map": stability_map.KIND,
}


def of(study):
    """The kind of a study; one that nobody knows shows its findings."""
    return stepping.KIND if study.steps_in_several_ways else KINDS.get(study.kind, Kind())


def drawings(study, styles):
    """The drawings of a study, in the order of its page. `styles`: of styles()."""
    return of(study).drawings(study, styles)


@lru_cache(maxsize=256)
def entries(study):
    """What a study says, a line for each finding."""
    return tuple(ledger.entries(study, of(study).disputes))


def styles(studies):
    """{scheme: Style} of the schemes whose run times are compared."""
    return styles_of(finding.series.scheme for study in with_run_times(studies) for finding in study.findings)


def with_run_times(studies):
    """Those whose schemes keep their looks in all figures and whose run times are compared."""
    return [study for study in studies if of(study).run_times]
