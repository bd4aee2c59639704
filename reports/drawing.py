"""Which figures a study gets, a function per kind of study; and their drawing, by several processes."""

from contextlib import suppress
from dataclasses import replace
from itertools import islice
import multiprocessing
from multiprocessing.connection import wait
import os
import signal

import bench_figures
import control_figures
import coverage_figures
import digit_figures
import extremes_figures
import figures
import look
import map_figures
import operator_figures
import pollution_figures
import scan_figures
import stability_map_figures
import stepping_figures
from results import CONVERGENCE

_OF_KIND = {"consistency": operator_figures.consistency_drawings, "identities": operator_figures.identity_drawings,
            "stability": operator_figures.stability_drawings, "controls": control_figures.drawings,
            "map": map_figures.drawings, "pollution": pollution_figures.drawings,
            "coverage": coverage_figures.drawings, "scan": scan_figures.drawings, "digits": digit_figures.drawings,
            "extremes": extremes_figures.drawings, "stability-map": stability_map_figures.drawings}


class DrawingKilled(Exception):
    """A drawing process ended before its drawing did; the text is one line."""


def of_study(study, styles):
    """The drawings of a study, in the order of its page. `styles`: of the convergence studies' schemes."""
    if study.kind in _OF_KIND:
        return _OF_KIND[study.kind](study)
    if study.kind != CONVERGENCE:
        return []
    return stepping_figures.drawings(study) if study.steps_in_several_ways else figures.drawings(study, styles)


def of_all(studies, benches, styles):
    """The rendered drawings of each study, and at the end those of all together and of the benches: an iterator of lists.

    DrawingKilled if a process of the drawing was killed. Ended early, it leaves no process.
    """
    tasks = [*((of_study, study, styles) for study in studies), (_of_cost, studies, styles),
             (bench_figures.drawings, benches, styles)]
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    processes = min(len(studies) + bool(benches), usable)
    if processes < 2:
        yield from map(_rendered, tasks)
        return
    # concurrent.futures would wait for what is being drawn after an interrupt, or hang where a process was killed while
    # it sent. Here each process has a connection of its own, which ends with it.
    workers = {}
    try:
        for _ in range(processes):
            connection, process = _start(tasks)
            workers[connection] = process
        yield from _in_turn(len(tasks), list(workers))
    finally:
        for process in workers.values():
            process.kill()
            process.join()


def _start(tasks):
    """(connection, process) that gets indices of `tasks` and sends back (index, drawings, error)."""
    here, there = multiprocessing.Pipe()
    process = multiprocessing.Process(target=_work, args=(there, tasks), daemon=True)
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})    # only the first process answers an interrupt
    try:
        process.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    there.close()
    return here, process


def _work(connection, tasks):
    with suppress(EOFError, ConnectionError):   # the first process is gone
        while True:
            i = connection.recv()
            try:
                message = i, _rendered(tasks[i]), None
            except Exception as error:
                message = i, None, error
            connection.send(message)


def _in_turn(count, connections):
    """What the tasks 0 .. count - 1 give, in this order; a process gets its next task when it is done with the last."""
    left, done = iter(range(count)), {}
    try:
        for connection, i in zip(connections, left):
            connection.send(i)
        for turn in range(count):
            while turn not in done:
                for connection in wait(connections):
                    i, done[i], error = connection.recv()
                    if error:
                        raise error
                    for following in islice(left, 1):
                        connection.send(following)
            yield done.pop(turn)
    except (EOFError, ConnectionError) as error:
        raise DrawingKilled("a drawing process was killed; free memory and draw again") from error


def _of_cost(studies, styles):
    return list(filter(None, [figures.cost_drawing(studies, styles)]))


def _rendered(task):
    draw, what, styles = task
    return [replace(one, files=look.render(one.figure, one.title), figure=None) for one in draw(what, styles)]
