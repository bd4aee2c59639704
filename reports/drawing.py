"""Which figures a study gets: a function per kind of study."""

import control_figures
import coverage_figures
import figures
import map_figures
import operator_figures
import pollution_figures
from results import CONVERGENCE

_OF_KIND = {"consistency": operator_figures.consistency_drawings, "identities": operator_figures.identity_drawings,
            "stability": operator_figures.stability_drawings, "controls": control_figures.drawings,
            "map": map_figures.drawings, "pollution": pollution_figures.drawings,
            "coverage": coverage_figures.drawings}


def of_study(study, styles):
    """The drawings of a study, in the order of its page. `styles`: of the convergence studies' schemes."""
    if study.kind in _OF_KIND:
        return _OF_KIND[study.kind](study)
    return figures.drawings(study, styles) if study.kind == CONVERGENCE else []
