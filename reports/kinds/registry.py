"""The registry of kinds: which drawings a study gets, a row per kind of study."""

from kinds import (controls, convergence, coverage, digits, error_map, extremes, operators, pollution, scan, stepping)
from kinds.stability_map import maps as stability_map
from reading.results import CONVERGENCE

_DRAWINGS = {"consistency": operators.consistency_drawings, "identities": operators.identity_drawings,
             "stability": operators.stability_drawings, "controls": controls.drawings, "map": error_map.drawings,
             "pollution": pollution.drawings, "coverage": coverage.drawings, "scan": scan.drawings,
             "digits": digits.drawings, "extremes": extremes.drawings, "stability-map": stability_map.drawings}


def drawings(study, styles):
    """The drawings of a study, in the order of its page. `styles`: of the convergence studies' schemes."""
    if study.kind in _DRAWINGS:
        return _DRAWINGS[study.kind](study)
    if study.kind != CONVERGENCE:
        return []
    return stepping.drawings(study) if study.steps_in_several_ways else convergence.drawings(study, styles)
