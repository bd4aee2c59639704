#!/usr/bin/env python3
"""Compares acstudy with what else computes the same cases: errors, which have to be equal, and run times.

The programs run one after the other on the same cases, round after round, on the same machine. A program that is not
installed is skipped. Raw samples, ratios and their spread go to OUT/compare.json and, as tables, to stdout.
Exit codes: 0 done; 1 an error is not that of acstudy, or a program failed; 2 bad usage; 4 acstudy cannot be run or OUT
cannot be written.
"""

import argparse
from dataclasses import asdict
import json
import os
from pathlib import Path
import platform
import sys
import tempfile

import programs as known
import selection
import strict_json
import summary

FORMAT = "acstudy comparison 1"
FILE = "compare.json"
# of three rounds
HOW_LONG = {"quick": "some 45 s", "default": "some 5 minutes", "all": "some 30 minutes"}
LEVELS = {"quick": selection.coarsest, "default": selection.representative, "all": selection.every}


class Failure(Exception):
    """The comparison cannot go on; the text is one line."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


def main(arguments=None):
    options = read_options(arguments)
    try:
        if options.table:
            found = read_comparison(options.out / FILE)
        else:
            say(f"{HOW_LONG[options.level]} for three rounds, less where a program is not installed")
            with tempfile.TemporaryDirectory() as folder:
                found = compare(options, Path(folder))
            write(options.out / FILE, found)
        if found["wrong"]:
            raise Failure(1, "\ncompare.py: ".join(found["wrong"]))
        for table in found["tables"]:
            print(summary.markdown(table))
        print(f"{len(found['rounds'])} rounds of {found['command']} on {found['machine']}")
        for program in found["programs"]:
            if program["missing"]:
                print(f"skipped: {program['label']}: {program['missing']}")
    except Failure as failure:
        print(f"compare.py: {failure}", file=sys.stderr)
        return failure.code
    except known.ProgramFailed as failure:
        print(f"compare.py: {failure}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"compare.py: {error.filename or 'output'}: {error.strerror or error}", file=sys.stderr)
        return 4
    return 0


def read_options(arguments):
    parser = argparse.ArgumentParser(prog="compare.py", description=__doc__.partition("\n")[0])
    level = parser.add_mutually_exclusive_group()
    level.add_argument("--quick", dest="level", action="store_const", const="quick", default="default",
                       help="the coarsest level of each path; some 45 s")
    level.add_argument("--all", dest="level", action="store_const", const="all",
                       help="every case of the figures; some ten minutes per round")
    level.add_argument("--table", action="store_true", help="print the tables of the last comparison; runs nothing")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="rounds after the warm-up (default: 3)")
    parser.add_argument("--studies", nargs="+", choices=selection.STUDIES, default=list(selection.STUDIES),
                        metavar="NAME", help=f"of {', '.join(selection.STUDIES)} (default: all)")
    parser.add_argument("--programs", nargs="+", metavar="NAME", help="only these, and acstudy (default: all)")
    parser.add_argument("--out", type=Path, default=selection.ROOT / "reports" / "out" / "compare", metavar="DIR",
                        help="folder of compare.json (default: reports/out/compare)")
    parser.add_argument("--acstudy", default=str(selection.ROOT / "build" / "acstudy"), metavar="FILE",
                        help="the program (default: build/acstudy)")
    options = parser.parse_args(arguments)
    if options.rounds < 1:
        parser.error(f"--rounds {options.rounds}: one at least")
    options.command = " ".join(["scripts/compare/compare.py", *(sys.argv[1:] if arguments is None else arguments)])
    return options


def compare(options, folder):
    """The comparison, as it is stored; its tables are there unless an error is wrong."""
    if not os.access(options.acstudy, os.X_OK):
        raise Failure(4, f"{options.acstudy}: no such program; run make build, or name it with --acstudy")
    studies = [name for name in selection.STUDIES if name in options.studies]
    files = selection.write_studies(studies, LEVELS[options.level], folder)
    processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    cases = reference_cases(options.acstudy, files, folder)
    # Seconds per step: not in the quick comparison.
    nonlocal_N = [case.N for case in cases if case.source == "nonlocal"] if options.level != "quick" else []
    chosen = choose(known.all_programs(options.acstudy, files, processors, min(nonlocal_N, default=0)),
                    options.programs)
    taken = {program.name: [i for i, case in enumerate(cases) if program.takes(case)] for program in chosen}
    running = [program for program in chosen if not program.missing and taken[program.name]]

    wrong, rounds = [], []
    for program in running:
        warm_up(program, [cases[i] for i in taken[program.name]], folder)
    for number in range(options.rounds):
        rounds.append({})
        for program in running:
            mine = [cases[i] for i in taken[program.name]]
            outcome = run(program, mine, folder)
            say(f"round {number + 1} of {options.rounds}: {program.label}: {len(mine)} cases, "
                f"{outcome.process_seconds:.2f} s")
            wrong += summary.disagreements(mine, program, outcome)
            rounds[-1][program.name] = {
                "process_seconds": outcome.process_seconds,
                "cases": {i: {"error_linf": result[0], "seconds": result[1]}
                          for i, result in zip(taken[program.name], outcome.cases) if result}}
        if wrong:
            break
    stated = [{"name": program.name, "label": program.label, "version": program.version, "loops": program.loops,
               "missing": program.missing or (None if taken[program.name] else "none of the cases is one for it")}
              for program in chosen]
    summarized = None if wrong else summary.summarize(cases, stated, rounds)
    return {"format": FORMAT, "command": options.command, "machine": machine(processors), "level": options.level,
            "wrong": list(dict.fromkeys(wrong)), "summary": summarized,
            "tables": [summary.program_table(summarized), summary.group_table(summarized)] if summarized else [],
            "cases": [asdict(case) for case in cases], "programs": stated, "rounds": rounds}


def reference_cases(acstudy, files, folder):
    """The distinct cases of the cut studies, with acstudy's errors; its warm-up as well."""
    seconds, done = known.timed([acstudy, "run", *files, "--out", folder / "reference", "--fresh"])
    if done.returncode not in (0, 1):
        raise Failure(4, f"acstudy run: exit code {done.returncode}: {known.last_line(done.stdout)}")
    found = selection.read_results([file.stem for file in files], folder / "reference")
    say(f"{len(found)} distinct cases, {seconds:.2f} s by acstudy")
    return [case for case, _ in found.values()]


def choose(programs, names):
    if names is None:
        return programs
    unknown = sorted(set(names) - {program.name for program in programs})
    if unknown:
        raise Failure(2, f"no program {unknown[0]}; write one of {', '.join(program.name for program in programs)}")
    return [program for program in programs if program.name in (summary.BASE, *names)]


def warm_up(program, cases, folder):
    """Caches of files, and of what a program compiles at its first run, are filled by its cheapest cases."""
    cheapest = {}
    for case in sorted(cases, key=lambda case: case.N * case.steps):
        cheapest.setdefault(case.scene, case)
    run(program, list(cheapest.values()), folder)


def run(program, cases, folder):
    try:
        return program.run(cases, folder)
    except known.ProgramFailed as failure:
        raise Failure(1, f"{program.label}: {failure}") from failure


def machine(processors):
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            name = next((line.partition(":")[2].strip() for line in file if line.startswith("model name")), name)
    except OSError:
        pass
    return f"{name}, {processors} processor{'s' if processors > 1 else ''}, {platform.system()}"


def read_comparison(file):
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
        if found["format"] != FORMAT:
            raise ValueError(f"format = {found['format']!r}")
        for entry in ("wrong", "tables", "rounds", "command", "machine", "programs"):
            found[entry]
        return found
    except (KeyError, TypeError, ValueError) as error:
        raise Failure(2, f"{file}: not a comparison: {error}; run make compare again") from error


def write(file, found):
    file.parent.mkdir(parents=True, exist_ok=True)
    temporary = file.with_suffix(".tmp")
    temporary.write_text(strict_json.dumps(found, indent=1) + "\n", encoding="utf-8")
    os.replace(temporary, file)


def say(message):
    print(f"compare.py: {message}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
