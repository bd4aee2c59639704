"""Draws all figures of a report: what has not changed since the last one is taken from there."""

from dataclasses import dataclass
from functools import partial
from itertools import chain

from drawing import look
from kinds import registry, run_times
from kinds.bench import figures as bench_figures
from reading import processes
from reading.made import made


@dataclass(frozen=True)
class Drawn:
    """All figures of a report."""
    studies: dict       # {name of a study: its drawings}
    costs: list         # error against run time, one for each scene
    benches: list


def drawn(studies, benches, kept, formats=(), meanwhile=None):
    """The figures of studies and benches, each with files of these `formats`. `meanwhile`: of processes.results()."""
    tasks = list(_tasks(studies, benches))
    made_of = [(draw.__module__, *map(kept.of_file, files), more, formats) for files, (draw, _, *more) in tasks]
    found = made([task for _, task in tasks], made_of, kept,
                 partial(processes.results, work=partial(_rendered, formats=formats)), _parts,
                 lambda parts: list(chain.from_iterable(parts)), meanwhile)
    n = len(studies)
    return Drawn(dict(zip((study.name for study in studies), found)), [one for group in found[n:-1] for one in group],
                 found[-1])


def _rendered(task, formats):
    with processes.no_search_for_garbage():
        return [look.render(one, formats) for one in processes.called(task)]


def _parts(task, _):
    """A task for each drawing, whose figure is made where it is rendered if its kind leaves that for later."""
    draw, *arguments = task
    return [(list, (one,)) for one in draw(*arguments)] or [task]


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
