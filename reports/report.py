#!/usr/bin/env python3
"""Draws the figures and the page of acstudy's result files: python3 reports/report.py [OUT_DIR] [STUDY.h5 ...]
                        [--figures DIR [--format svg,png,pdf]] [--folder] [--against DIR ...]

Exit codes: 0 done; 2 bad usage, nothing written; 4 a file that cannot be read or written, or a process that was killed;
130 interrupted.
"""

import argparse
import os
from pathlib import Path
import sys
import tempfile

DEFAULT = "reports/out"
FORMATS = ("svg", "png", "pdf")
FRONT = "index.html"    # the page, or the first of its parts


class UsageError(Exception):
    """What was asked for cannot be done; the text is one line."""


def main(arguments=None):
    options = _options(arguments)
    try:
        # The libraries load in a second: only once the command line is known to be good.
        from reading import processes, results
        try:
            made = against(*_inputs(options), options.against) if options.against else report(
                *_inputs(options), *_figures(options), options.folder)
            print(made)
        except (results.ResultError, processes.DrawingKilled) as error:
            return _fail(4, error)
    except UsageError as error:
        return _fail(2, error)
    except ImportError as error:
        return _fail(4, f"{error}; install matplotlib, h5py and Jinja2 (Debian, Ubuntu, Fedora: "
                        "python3-matplotlib python3-h5py python3-jinja2; conda-forge and pip: matplotlib h5py jinja2)")
    except OSError as error:
        return _fail(4, f"{error.filename or 'output'}: {error.strerror or error}; free space or name another folder")
    except KeyboardInterrupt:
        return _fail(130, "interrupted; files already written are whole")
    return 0


def report(folder, files, figures=None, formats=(), parts=False):
    """Draws the figures of the result files and benches and the page into `folder`; the path of the page.

    figures: a folder for the figures as files of these `formats`, or None; parts: a page for each question.
    """
    from reading import bench_results, made
    from reading.kept import Kept

    kept = Kept(folder, _write)
    studies = made.studies(files, kept, meanwhile=_load)
    from pages import comparison, history, making, mutants, page
    _refuse_clashes(studies)
    benches = bench_results.read_all(folder)
    seeded, compared = mutants.read(folder), comparison.read(folder)
    words = []
    drawn = making.drawn(studies, benches, kept, formats, lambda: words.append(page.words(studies, benches, seeded)))
    if figures:
        figures.mkdir(parents=True, exist_ok=True)
        for one in (one for group in (*drawn.studies.values(), drawn.costs, drawn.benches) for one in group):
            for kind, content in one.files.items():
                _write(figures / f"{one.stem}.{kind}", content)
    pages = page.files(*words, drawn, compared, parts, kept)
    if (folder / history.FILE).is_file():
        pages[FRONT] = history.linked(pages[FRONT])
    for name, text in pages.items():
        _write(folder / name, text.encode("utf-8"))
    kept.clear()
    return folder / FRONT


def _load():
    """What draws and writes takes as long to load as a study to read."""
    from pages import making, page


def against(folder, files, earlier):
    """Writes the page of this run beside earlier ones, `earlier` being their folders, into `folder`; its path.

    A front page that is there gets a link to it.
    """
    from pages import history
    from reading import made
    from reading.kept import Kept

    kept = Kept(folder, _write)
    runs = []
    for name, of_run in (*((name, _results(Path(name))) for name in earlier), (str(folder), files)):
        if not of_run:
            raise UsageError(f"{name}: no result file (*.h5) in it; name a folder that acstudy run has written to")
        studies = made.studies(of_run, kept)
        _refuse_clashes(studies)
        runs.append(history.Run(name, tuple(studies)))
    _write(folder / history.FILE, history.html(runs).encode("utf-8"))
    if (folder / FRONT).is_file():
        _write(folder / FRONT, history.linked((folder / FRONT).read_text(encoding="utf-8")).encode("utf-8"))
    return folder / history.FILE


def _options(arguments):
    parser = argparse.ArgumentParser(
        prog="report.py", description="Draw the figures and the page of acstudy's result files.",
        epilog="exit codes: 0 done, 2 bad usage, 4 a file that cannot be read or written or a drawing process that was "
               "killed, 130 interrupted")
    parser.add_argument("out_dir", metavar="OUT_DIR", nargs="?", default=DEFAULT,
                        help=f"folder of the result files and of the report (default: {DEFAULT})")
    parser.add_argument("studies", metavar="STUDY.h5", nargs="*",
                        help="result files to report on (default: all in OUT_DIR)")
    parser.add_argument("--figures", metavar="DIR", help="write the figures as files into DIR too")
    parser.add_argument("--format", metavar="LIST", help=f"of those files, with commas: {', '.join(FORMATS)} (default: svg)")
    parser.add_argument("--folder", action="store_true",
                        help="write a page for each question beside index.html, not one page that can be mailed")
    parser.add_argument("--against", metavar="DIR", action="append", default=[],
                        help="write history.html instead: results beside those in DIR; several times: oldest first")
    options = parser.parse_args(arguments)
    if options.against and (options.figures or options.folder):
        parser.error("--against writes no figures and one page; leave out --figures and --folder")
    if options.out_dir.endswith(".h5") and not Path(options.out_dir).is_dir():
        options.studies.insert(0, options.out_dir)
        options.out_dir = DEFAULT
    return options


def _figures(options):
    """(folder of the figures or None, their formats)."""
    if options.format and not options.figures:
        raise UsageError(f"--format {options.format}: of which files? name their folder with --figures DIR")
    if not options.figures:
        return None, ()
    formats = tuple(dict.fromkeys((options.format or "svg").split(",")))
    for one in formats:
        if one not in FORMATS:
            raise UsageError(f'--format: "{one}" is no format of a figure; write some of {", ".join(FORMATS)}, with commas')
    return Path(options.figures), formats


def _inputs(options):
    folder = Path(options.out_dir)
    named = [Path(name) for name in options.studies]
    files = _results(folder) if not named or not folder.is_dir() else named
    if not files and not list(folder.glob("bench*/bench.json")):
        raise UsageError(f"{folder}: no result file (*.h5) in it; run a study first")
    for file in files:
        if not file.is_file():
            raise UsageError(f"{file}: no such file; run the study first or name one of its result files")
    return folder, files


def _results(folder):
    """The result files in a folder."""
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such folder; run a study first or name the folder of the result files")
    return sorted(file for file in folder.glob("*.h5") if not file.name.startswith("."))


def _refuse_clashes(studies):
    """Two studies of one name would share a place, and cost and bench are names of other figures."""
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
