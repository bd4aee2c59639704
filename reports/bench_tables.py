#!/usr/bin/env python3
"""Prints what benches measured as Markdown tables: python3 reports/bench_tables.py [--ways] [OUT_DIR]

OUT_DIR is the folder of the results, with the benches in OUT_DIR/bench*/bench.json. The tables: seconds to reach an
error, the law of cost, the prices of work, threads. Where the time goes is on the page of the report.
--ways: of the studies that step in several ways instead, seconds to reach an error and what a step costs, way by way.
What is missing of them, as on a disturbed machine, is said on stderr.
Exit codes: 0 done; 2 no bench, or not one.
"""

from pathlib import Path
import shutil
import sys
import textwrap

from kinds.bench import tables, ways
from reading import bench_results, results

DEFAULT = "reports/out"


def main(arguments):
    of_ways = "--ways" in arguments
    arguments = [argument for argument in arguments if argument != "--ways"]
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        asked = arguments in (["-h"], ["--help"])
        print(__doc__.strip(), file=sys.stdout if asked else sys.stderr)
        return 0 if asked else 2
    folder = Path(arguments[0] if arguments else DEFAULT)
    try:
        benches = bench_results.read_all(folder)
    except results.ResultError as error:
        return _fail(error)
    if not benches:
        return _fail(f"{folder}: no bench ({bench_results.PLACES}) in it; run make bench first, or name the folder")
    chosen = [bench for bench in benches if of_ways == any(map(ways.stepped, bench.curves))]
    if of_ways and not chosen:
        return _fail(f"{folder}: no bench of studies that step in several ways; run make bench first")
    for title, header, rows, note in ways.tables(chosen) if of_ways else tables.tables(benches):
        print(f"**{title}**\n\n{markdown(header, rows)}\n" + (f"{note}\n" if note else ""))
    for line in [] if of_ways else tables.left_out(benches):
        _say(line)
    print(measured_by(chosen))
    return 0


def measured_by(benches):
    """A line per bench: machine, program, command, and how often."""
    said = []
    for bench in benches:
        origin = bench.provenance
        unfinished = "" if bench.complete else " It was interrupted: some cases have fewer runs."
        said.append(f"Measured {origin['created'][:10]} on {origin['machine']} ({origin['system']}), acstudy "
                    f"{origin['version']}, {origin['compiler']} {origin['flags']}: `{origin['command']}`; each case at "
                    f"least {bench.runs} times and {bench.least_seconds:g} s, medians.{unfinished}\n")
    return "\n".join(said)


def markdown(header, rows):
    """A table with its columns aligned, so that it can be read as it stands."""
    cells = [header, *rows]
    widths = [max(len(row[i]) for row in cells) for i in range(len(header))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |" for row in cells]
    return "\n".join([lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]]) + "\n"


def _fail(message):
    _say(message)
    return 2


def _say(message):
    line = f"bench_tables.py: {message}"
    if sys.stderr.isatty():
        line = textwrap.fill(line, shutil.get_terminal_size().columns, subsequent_indent="    ")
    print(line, file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
