"""What is made of result files, the studies in them first: kept from the last report, or made by several processes."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
import gc
from itertools import chain

from reading import processes, results

LARGE = 1 << 20     # bytes of a file that is read by several processes if it is the only one


def studies(files, kept, meanwhile=None):
    """The studies in result files. `kept`: a reading.kept.Kept; `meanwhile`: of processes.results()."""
    with ThreadPoolExecutor(processes.usable()) as threads:     # what is large is digested without Python's lock
        made_of = list(threads.map(lambda file: ("study", kept.of_file(file)) if file.is_file() else (), files))
    with processes.no_search_for_garbage():
        found = made([(results.read_study, file) for file in files], made_of, kept, processes.results, _parts_of_file,
                     results.joined, meanwhile)
    gc.freeze()     # they stay to the end
    return [replace(study, file=file) for study, file in zip(found, files)]


def _parts_of_file(task, n):
    read, file = task
    return [(read, file, (k, n)) for k in range(n)] if file.is_file() and file.stat().st_size > LARGE else [task]


def made(tasks, made_of, kept, make, parts=None, join=None, meanwhile=None):
    """What each task gives, kept or made; `made_of`: of each, what it depends on. Without `kept` all are made.

    make: (tasks, at_most, meanwhile=) -> an iterator, such as processes.results();
    parts: (task, n) -> tasks that together do the same, for n processes that had nothing else to do; `join`: what they
    give, to what the task gives.
    """
    if kept is None:
        return list(make(tasks, 1))
    found = [None] * len(tasks)
    missing = [i for i, one in enumerate(made_of) if not kept.has(*one)]

    def take():
        for i in set(range(len(tasks))).difference(missing):
            found[i] = kept.get(*made_of[i])
        if meanwhile:
            meanwhile()

    def fill(places, meanwhile):
        n = processes.usable() // max(1, len(places)) if parts else 1
        groups = [parts(tasks[i], n) if n > 1 else [tasks[i]] for i in places]
        all_parts = list(chain.from_iterable(groups))
        with closing(make(all_parts, len(all_parts), meanwhile=meanwhile)) as in_turn:
            for i, group in zip(places, groups):
                first, *others = [next(in_turn) for _ in group]
                found[i] = join([first, *others]) if others else first
                kept.keep(found[i], *made_of[i])
            for _ in in_turn:       # to its end, for what is done meanwhile without any task
                pass

    fill(missing, take)
    damaged = [i for i, one in enumerate(found) if one is None]
    if damaged:
        fill(damaged, None)
    return found
