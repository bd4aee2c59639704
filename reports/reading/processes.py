"""Reading and drawing by several processes."""

from contextlib import contextmanager, suppress
import gc
from itertools import islice
import multiprocessing
from multiprocessing.connection import wait
import os
import signal


class DrawingKilled(Exception):
    """A drawing process ended before its drawing did; the text is one line."""


def usable():
    """How many processes can run at a time."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def results(tasks, at_most, work=None, meanwhile=None):
    """What each task (function, *arguments) gives, or `work` of the task: an iterator in the order of the tasks, by
    `at_most` processes. `meanwhile()` is called once, in this process, while others are at work.

    DrawingKilled if a process was killed. Ended early, it leaves no process.
    """
    work, meanwhile = work or called, meanwhile or _nothing
    processes = min(at_most, usable())
    if processes < 2:
        meanwhile()
        yield from map(work, tasks)
        return
    # concurrent.futures would wait for what is being drawn after an interrupt, or hang where a process was killed while
    # it sent. Here each process has a connection of its own, which ends with it.
    workers = {}
    try:
        for _ in range(processes):
            connection, process = _start(tasks, work)
            workers[connection] = process
        yield from _in_turn(len(tasks), list(workers), meanwhile)
    finally:
        for process in workers.values():
            process.kill()
            process.join()


def _start(tasks, work):
    """(connection, process) that gets indices of `tasks` and sends back (index, drawings, error)."""
    here, there = multiprocessing.Pipe()
    process = multiprocessing.Process(target=_work, args=(there, tasks, work), daemon=True)
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})    # only the first process answers an interrupt
    try:
        process.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    there.close()
    return here, process


def _work(connection, tasks, work):
    gc.freeze()     # what is there already stays, and need not be searched
    with suppress(EOFError, ConnectionError):   # the first process is gone
        while True:
            i = connection.recv()
            try:
                message = i, work(tasks[i]), None
            except Exception as error:
                message = i, None, error
            connection.send(message)


def _in_turn(count, connections, meanwhile):
    """What the tasks 0 .. count - 1 give, in this order; a process gets its next task when it is done with the last."""
    left, done = iter(range(count)), {}
    try:
        for connection, i in zip(connections, left):
            connection.send(i)
        meanwhile()
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


def called(task):
    function, *arguments = task
    with no_search_for_garbage():
        return function(*arguments)


def _nothing():
    """Meanwhile."""


@contextmanager
def no_search_for_garbage():
    """Figures and findings are many objects that stay: to look for garbage among them takes a fifth of the time."""
    on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if on:
            gc.enable()
