"""Which figures a study gets, a function per kind of study; and their drawing, by several processes."""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
import multiprocessing
import os
import signal

import control_figures
import coverage_figures
import figures
import look
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


def of_all(studies, styles):
    """The rendered drawings of each study, and at the end those of all together: an iterator of lists."""
    tasks = [*((of_study, study, styles) for study in studies), (_of_cost, studies, styles)]
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    processes = min(len(studies), usable)
    if processes < 2:
        yield from map(_rendered, tasks)
        return
    # Only the first process answers an interrupt.
    with ProcessPoolExecutor(processes, multiprocessing.get_context(), signal.signal,
                             (signal.SIGINT, signal.SIG_IGN)) as pool:
        yield from pool.map(_rendered, tasks)


def _of_cost(studies, styles):
    return list(filter(None, [figures.cost_drawing(studies, styles)]))


def _rendered(task):
    draw, what, styles = task
    return [replace(one, files=look.render(one.figure, one.title), figure=None) for one in draw(what, styles)]
