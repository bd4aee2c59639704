"""The programs that are compared: how each is found, which cases it takes, and one run of it."""

from dataclasses import dataclass
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys
import time
from typing import Callable, Optional

import selection
import strict_json

HERE = Path(__file__).resolve().parent
# Every program but acstudy --jobs N is compared on one core.
ONE_THREAD = {**os.environ, **{f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL", "VECLIB")}}


class ProgramFailed(Exception):
    """A program did not do its cases; the text is one line."""


@dataclass(frozen=True)
class Outcome:
    """One run: wall time of the process; (error, seconds of the time loop) of each case, None where left out."""
    process_seconds: float
    cases: list


@dataclass(frozen=True)
class Program:
    name: str
    label: str
    run: Callable                           # of cases and a scratch folder: an Outcome
    takes: Callable = lambda case: True
    version: str = ""
    missing: Optional[str] = None           # why it cannot be run, with what to install
    loops: bool = True                      # False: its cases share threads, so that their seconds add up to nothing


def timed(command, environment=None):
    """Wall seconds of a command, and what it said and its exit code, as a CompletedProcess."""
    started = time.perf_counter()
    done = subprocess.run([str(word) for word in command], env=environment, text=True, errors="replace", check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    seconds = time.perf_counter() - started
    return seconds, done


def last_line(text):
    return (text.strip().splitlines() or ["no message"])[-1]


# ------------------------------------------------------------------------------------------------------------ acstudy

def acstudy_run(acstudy, files, *options):
    """A function of cases and a folder that runs the studies `files` with acstudy and picks the cases."""
    names = [file.stem for file in files]

    def run(cases, folder):
        out = folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        seconds, done = timed([acstudy, "run", *files, "--out", out, "--fresh", "--repeats", "1", *options])
        if done.returncode not in (0, 1):   # 1: few levels settle no verdict
            raise ProgramFailed(f"exit code {done.returncode}: {last_line(done.stdout)}")
        results = selection.read_results(names, out)
        return Outcome(seconds, [(results[case.key][0].error_linf, results[case.key][1]) for case in cases])

    return run


def acstudy_programs(acstudy, files, processors):
    said = timed([acstudy, "run", "--help"])[1].stdout
    version = last_line(timed([acstudy, "--version"])[1].stdout)
    programs = [Program("acstudy", "acstudy", acstudy_run(acstudy, files, "--jobs", "1"), version=version)]
    if processors > 1:
        programs.append(Program("acstudy-threads", f"acstudy, {processors} threads",
                                acstudy_run(acstudy, files, "--jobs", str(processors)), version=version, loops=False))
    missing = None if "--form" in said else "this acstudy has one form only: no --form in acstudy run --help"
    programs.append(Program("acstudy-readable", "acstudy, readable form",
                            acstudy_run(acstudy, files, "--jobs", "1", "--form", "readable"), version=version,
                            missing=missing))
    return programs


# ------------------------------------------------------------------------------------------------- the other programs

def run_by_file(*command):
    """A function of cases and a folder that hands the cases to `command` and reads its answers."""

    def run(cases, folder):
        asked, answered = folder / "cases.json", folder / "results.json"
        asked.write_text(strict_json.dumps([case.asked() for case in cases]), encoding="utf-8")
        answered.unlink(missing_ok=True)
        before, after = command
        seconds, done = timed([*before, asked, answered, *after], ONE_THREAD)
        if done.returncode != 0 or not answered.is_file():
            raise ProgramFailed(f"exit code {done.returncode}: {last_line(done.stdout)}")
        results = json.loads(answered.read_text(encoding="utf-8"))
        if len(results) != len(cases):
            raise ProgramFailed(f"{len(results)} results for {len(cases)} cases")
        return Outcome(seconds, [None if "left_out" in one else (strict_json.number(one["error_linf"]), one["seconds"])
                                 for one in results])

    return run


def python_with(*modules):
    """(interpreter, versions) of the first Python that can import the modules; (None, "")."""
    code = ("import importlib as i; print(', '.join('%s %s' % (m, i.import_module(m).__version__) "
            f"for m in {modules!r}))")
    for candidate in dict.fromkeys((sys.executable, os.environ.get("PYTHON"), "python3", "/usr/bin/python3")):
        found = shutil.which(candidate) if candidate else None
        done = timed([found, "-c", code])[1] if found else None
        if done and done.returncode == 0:
            return found, last_line(done.stdout)
    return None, ""


def python_program(name, label, script, modules, package, **options):
    """The first of `modules` is needed, the others are not."""
    python, version = python_with(*modules)
    if not python:
        python, version = python_with(modules[0])
    missing = None if python else f"no python3 with {modules[0]} (Debian: {package})"
    return Program(name, label, run_by_file([python, HERE / script], []), version=version, missing=missing, **options)


def octave_program(name, label, rule, octave, version, missing, **options):
    return Program(name, label, run_by_file([octave, "--norc", "--quiet", HERE / "octave_pairs.m"], [rule]),
                   version=version, missing=missing, **options)


def octave_programs(coarsest_nonlocal):
    """`coarsest_nonlocal`: the particle number at which adaptive quadrature is affordable; 0: at none."""
    octave = shutil.which("octave-cli") or shutil.which("octave")
    version, missing = "", "no octave (Debian: octave)"
    if octave:
        done = timed([octave, "--norc", "--quiet", "--eval", "jsondecode('1'); printf('Octave %s', version())"])[1]
        version, missing = last_line(done.stdout), None
        if done.returncode != 0:
            missing = "this Octave is older than 7: it knows no jsondecode"

    def adaptive(case):
        return case.source == "nonlocal" and case.N == coarsest_nonlocal

    known = (octave, version, missing)
    return [octave_program("octave", "Octave", "gauss", *known),
            octave_program("octave-integral", "Octave, integral", "integral", *known, takes=adaptive),
            octave_program("octave-quadgk", "Octave, quadgk per particle", "quadgk", *known,
                           takes=lambda case: adaptive(case) and case.model == 1)]


def all_programs(acstudy, files, processors, coarsest_nonlocal):
    numpy = (("numpy", "scipy"), "python3-numpy python3-scipy")
    return [*acstudy_programs(acstudy, files, processors),
            python_program("numpy-views", "NumPy, tuned", "numpy_views.py", *numpy),
            python_program("numpy-pairs", "NumPy, as printed", "numpy_pairs.py", *numpy),
            *octave_programs(coarsest_nonlocal),
            python_program("pysph", "PySPH", "pysph_standing.py", ("pysph",), "python3-pysph",
                           takes=lambda case: case.scene == "standing")]
