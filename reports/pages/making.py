"""Reads results and draws their figures: what has not changed since the last report is taken from there."""

from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
import gc

from drawing import processes
from kinds import registry, run_times
from kinds.bench import figures as bench_figures
from reading import results


@dataclass(frozen=True)
class Drawn:
    """All figures of a report."""
    studies: dict       # {name of a study: its drawings}
    costs: list         # error against run time, one for each scene
    benches: list


def read(files, kept):
    """The studies in result files. `kept`: a reading.kept.Kept."""
    made_of = [("study", kept.of_file(file)) if file.is_file() else () for file in files]
    with processes.no_search_for_garbage():
        found = made([(results.read_study, file) for file in files], made_of, kept, processes.results)
    gc.freeze()     # they stay to the end
    return [replace(study, file=file) for study, file in zip(found, files)]


def drawn(studies, benches, kept, formats=()):
    """The figures of studies and benches, each with files of these `formats`."""
    tasks = list(_tasks(studies, benches))
    made_of = [(draw.__module__, *map(kept.of_file, files), more, formats) for files, (draw, _, *more) in tasks]
    found = made([task for _, task in tasks], made_of, kept, partial(processes.in_turn, formats=formats))
    n = len(studies)
    return Drawn(dict(zip((study.name for study in studies), found)), [one for group in found[n:-1] for one in group],
                 found[-1])


def made(tasks, made_of, kept, make):
    """What each task gives, kept or made by `make`; `made_of`: of each, what it depends on. Without `kept` all are made."""
    if kept is None:
        return list(make(tasks, 1))
    found = [kept.get(*one) for one in made_of]
    missing = [i for i, one in enumerate(found) if one is None]
    with closing(make([tasks[i] for i in missing], len(missing))) as in_turn:
        for i, one in zip(missing, in_turn):
            found[i] = one
            kept.keep(one, *made_of[i])
    return found


def _tasks(studies, benches):
    """(files, (draw, what is in them, what else the drawing is made of)) of every drawing."""
    styles = registry.styles(studies)
    for study in studies:
        yield [study.file], (registry.drawings, study, _looks(styles, [study]))
    for scene, group in run_times.scenes(registry.with_run_times(studies)).items():
        yield [study.file for study in group], (run_times.drawings, group, _looks(styles, group), scene)
    yield [bench.file for bench in benches], (bench_figures.drawings, benches, styles if benches else {})


def _looks(styles, studies):
    """Those of the schemes of these studies: they depend on all studies of a report."""
    schemes = {finding.series.scheme for study in studies for finding in study.findings if finding.series}
    return {scheme: style for scheme, style in styles.items() if scheme in schemes}
