"""Which figures a study gets: a function per kind of study."""

import figures

_OF_KIND = {}


def of_study(study, styles):
    """The drawings of a study, in the order of its page. `styles`: of the convergence studies' schemes."""
    if study.kind in _OF_KIND:
        return _OF_KIND[study.kind](study)
    return figures.drawings(study, styles) if study.kind == "convergence" else []
