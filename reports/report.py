#!/usr/bin/env python3
"""Draws the figures and the page of acstudy's result files: python3 reports/report.py [OUT_DIR] [STUDY.h5 ...]

Exit codes: 0 done; 2 bad usage, nothing written; 4 a file that cannot be read or written, or a process that was killed;
130 interrupted.
"""

import argparse
from contextlib import closing
import os
from pathlib import Path
import sys
import tempfile

DEFAULT = "reports/out"


class UsageError(Exception):
    """What was asked for cannot be done; the text is one line."""


def main(arguments=None):
    options = _options(arguments)
    try:
        # The libraries load in a second: only once the command line is known to be good.
        from drawing import processes
        from reading import results
        try:
            print(report(*_inputs(options)))
        except (results.ResultError, processes.DrawingKilled) as error:
            return _fail(4, error)
    except UsageError as error:
        return _fail(2, error)
    except ImportError as error:
        return _fail(4, f"{error}; install matplotlib and h5py (Debian, Ubuntu, Fedora: python3-matplotlib "
                        "python3-h5py; conda-forge and pip: matplotlib h5py)")
    except OSError as error:
        return _fail(4, f"{error.filename or 'output'}: {error.strerror or error}; free space or name another folder")
    except KeyboardInterrupt:
        return _fail(130, "interrupted; files already written are whole")
    return 0


def report(folder, files):
    """Draws every figure of the result files and benches and the pages into `folder`; the path of the first page."""
    from drawing import processes
    from kinds import registry, run_times
    from kinds.bench import figures as bench_figures
    from pages import bench as bench_page, claims, comparison, mutants, page
    from reading import bench_results, results

    with closing(processes.results([(results.read_study, file) for file in files], len(files))) as read_in_turn:
        studies = list(read_in_turn)
    _refuse_clashes(studies)
    seeded, compared = mutants.read(folder), comparison.read(folder)
    benches = bench_results.read_all(folder)
    styles = registry.styles(studies)
    drawings = {}
    names = (*(study.name for study in studies), "cost", "bench")
    tasks = [*((registry.drawings, study, styles) for study in studies),
             (run_times.drawings, registry.with_run_times(studies), styles), (bench_figures.drawings, benches, styles)]
    with closing(processes.in_turn(tasks, len(studies) + bool(benches), ("svg",))) as drawn_in_turn:
        for name, drawn in zip(names, drawn_in_turn):
            for one in drawn:
                for kind, content in one.files.items():
                    _write(folder / f"{one.stem}.{kind}", content)
            drawings[name] = drawn
    cost = drawings.pop("cost")
    of_benches = drawings.pop("bench")
    if benches:
        links = [("index.html", "all studies")] if studies else []
        _write(folder / bench_page.FILE, bench_page.html(benches, of_benches, links).encode("utf-8"))
    if not studies:
        return folder / bench_page.FILE
    index = folder / "index.html"
    _write(index, page.html(studies, drawings, cost, seeded, compared, bool(benches)).encode("utf-8"))
    _write(folder / "claims.html", claims.html(studies, drawings).encode("utf-8"))
    return index


def _options(arguments):
    parser = argparse.ArgumentParser(
        prog="report.py", description="Draw the figures and the page of acstudy's result files.",
        epilog="exit codes: 0 done, 2 bad usage, 4 a file that cannot be read or written or a drawing process that was "
               "killed, 130 interrupted")
    parser.add_argument("out_dir", metavar="OUT_DIR", nargs="?", default=DEFAULT,
                        help=f"folder of the result files and of the report (default: {DEFAULT})")
    parser.add_argument("studies", metavar="STUDY.h5", nargs="*",
                        help="result files to report on (default: all in OUT_DIR)")
    options = parser.parse_args(arguments)
    if options.out_dir.endswith(".h5") and not Path(options.out_dir).is_dir():
        options.studies.insert(0, options.out_dir)
        options.out_dir = DEFAULT
    return options


def _inputs(options):
    folder = Path(options.out_dir)
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such folder; run a study first or name the folder of the result files")
    named = [Path(name) for name in options.studies]
    files = named or sorted(file for file in folder.glob("*.h5") if not file.name.startswith("."))
    if not files and not list(folder.glob("bench*/bench.json")):
        raise UsageError(f"{folder}: no result file (*.h5) in it; run a study first")
    for file in files:
        if not file.is_file():
            raise UsageError(f"{file}: no such file; run the study first or name one of its result files")
    return folder, files


def _refuse_clashes(studies):
    """Two studies of one name would overwrite each other's figure, and cost and bench are names of other figures."""
    seen = {}
    for study in studies:
        if study.name in ("cost", "bench"):
            raise UsageError(f'{study.file}: study = "{study.name}"; the {study.name} figure has this name; rename the '
                             "study")
        if study.name in seen:
            raise UsageError(f'{study.file}: study = "{study.name}" is also in {seen[study.name]}; name one of them')
        seen[study.name] = study.file


def _write(path, content):
    """All of the file or nothing: a killed run leaves the old one."""
    handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        # A temporary file is private; a report is as readable as any new file.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _fail(code, message):
    print(f"report.py: {message}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
