"""Studies: run, and read as a table."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any, Iterable, Optional, Union

import numpy as np

from acstudy.program import ask

try:
    import pandas
except ImportError:
    pandas = None

Place = Union[str, "os.PathLike[str]"]

# Columns of a table of results, besides N and as_expected.
TEXT = ("study", "kind", "statement", "scheme", "path", "kernel", "integrator", "source", "quantity", "verdict",
        "expected", "reason")
OF_LEVEL = ("h", "delta", "dt", "steps", "error_linf", "error_l1", "error_l2", "value", "seconds")
OF_SERIES = ("order", "low", "high", "theory_order")


def run(*studies: Place, out: Place = "reports/out", jobs: Optional[int] = None, fresh: bool = False) -> Any:
    """Runs study files into the folder `out` and gives their `results`. Cases that are stored there are not run again.

    jobs: cases run at the same time, by default as many as there are processors. fresh: stored cases are run again.
    A verdict that departs from what its study expects raises nothing; its column `as_expected` is False. InputError if
    a study is refused, before anything is run; Error if the machine fails the run.
    """
    names = [ask("explain", study)[1].partition(" - ")[0] for study in studies]
    options = [*(["--jobs", jobs] if jobs is not None else []), *(["--fresh"] if fresh else [])]
    ask("run", *studies, "--out", out, "--quiet", *options, codes=(0, 1, 3))
    return results(out, names)


def results(out: Place = "reports/out", studies: Optional[Iterable[str]] = None) -> Any:
    """The results in a folder: a pandas DataFrame, or a NumPy structured array where there is no pandas.

    A row is a case, coarse to fine in each series, or a measured value of a study of another kind. Its columns:

    study, kind, statement, scheme, path   what was run; path: the conditions of the check, in words
    kernel, integrator, source             empty where there is none
    N, h, delta, dt, steps                 particles, spacing, horizon, time step
    error_linf, error_l1, error_l2         at the final time, over the period; NaN where nothing was run
    quantity, value                        what is judged, and its value here
    seconds                                run time of the case
    order, low, high, theory_order         of the series: order in the limit, its 95 % interval, theory's
    verdict, expected, as_expected, reason of the series

    What is not known is NaN or an empty text. studies: their names, all in the folder by default. FileNotFoundError if
    there are no results.
    """
    files = sorted(Path(out).glob("*.json") if studies is None else (Path(out, f"{name}.json") for name in studies))
    rows = [row for file in files for row in _rows(json.loads(file.read_text(encoding="utf-8")))]
    if not rows:
        raise FileNotFoundError(f"{out}: no results; run a study with out={os.fspath(out)!r} first")
    if pandas is not None:
        return pandas.DataFrame(rows)
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    table = np.empty(len(rows), [(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return table


def _rows(result: Any) -> Iterable[dict[str, Any]]:
    """A row for each case or value of a result file; none of another file."""
    if not isinstance(result, dict) or "study" not in result:
        return
    findings = result.get("series", result.get("findings", []))
    for finding in findings:
        known = {**result, **finding.get("coordinates", {}), **finding, **finding.get("observed", {}),
                 "scheme": finding["subject"], "path": finding["check"]}
        for level in finding["cases"] if "cases" in finding else finding["points"]:
            level = {"value": level.get("error_linf"), **level}
            yield {**{name: str(known.get(name, "")) for name in TEXT}, "N": level["N"],
                   **{name: _number(level.get(name)) for name in OF_LEVEL},
                   **{name: _number(known.get(name)) for name in OF_SERIES}, "as_expected": finding["as_expected"]}


def _number(value: Optional[float]) -> float:
    return math.nan if value is None else float(value)
