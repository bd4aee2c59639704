"""Benches, read into plain records: Bench > Curve > an array entry per case.

Reading only: nothing here computes, draws or writes. The layout is the format "acstudy-bench-1" of `acstudy bench`.
"""

from __future__ import annotations

from dataclasses import dataclass
import json
from pathlib import Path

import numpy as np

from reading.results import ResultError, Scheme

FORMAT = "acstudy-bench-1"
PLACES = "bench*/bench.json"    # in the folder of the results
PARTS = ("positions_seconds", "weights_seconds", "pairs_seconds", "source_seconds")


@dataclass(frozen=True)
class Spread:
    """Statistics of the samples of each case: every member is an array [n]; NaN for a case that was not timed."""
    median: np.ndarray
    minimum: np.ndarray
    deviation: np.ndarray   # median absolute deviation from the median


@dataclass(frozen=True, eq=False)     # arrays have no hash and no truth
class Curve:
    """The cases of one scheme along one path with one number of threads, coarse to fine: arrays [n]."""
    studies: tuple          # that asked for some of these cases
    title: str              # of the first of them
    scheme: Scheme
    path: str
    source: str
    delta_text: str
    step_text: str
    integrator: str
    stepping: str           # integrator and rule of steps, where a study has several; else empty
    motion: str             # "moving" | "standing"
    scene: str
    T: float
    threads: int
    N: np.ndarray
    h: np.ndarray
    delta: np.ndarray
    steps: np.ndarray
    stages: np.ndarray
    error: np.ndarray       # max norm; NaN: no solution
    seconds: Spread
    parts: dict             # {name of PARTS: Spread}
    pairs: np.ndarray       # pair interactions
    runs: np.ndarray        # number of samples

    def __len__(self):
        return len(self.N)

    @property
    def neighbors(self):
        """delta/h, or 1 where the horizon is below the spacing: the nearest neighbor always counts."""
        return np.maximum(self.delta / self.h, 1.0)


@dataclass(frozen=True)
class Bench:
    """One bench: everything in it was measured in turn, on one machine."""
    file: Path
    complete: bool
    runs: int               # least number of samples of a case
    least_seconds: float
    provenance: dict
    curves: tuple


def read_all(folder):
    """The benches below the folder of results, in the order of their names."""
    return tuple(read_bench(file) for file in sorted(Path(folder).glob(PLACES)))


def read_bench(path):
    """The bench in the file `path`; ResultError if it is missing, damaged or of another format."""
    path = Path(path)
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(found, dict) or found.get("format") != FORMAT:
            raise ValueError(f'not of format "{FORMAT}"')
        cases = found["cases"]
        together = {}
        for series in found["series"]:
            together.setdefault(_identity(series), []).append(series)
        return Bench(file=path, complete=found["complete"], runs=found["runs"], least_seconds=found["least_seconds"],
                     provenance=found["provenance"],
                     curves=tuple(_curve(identity, group, cases) for identity, group in together.items()))
    except FileNotFoundError as error:
        raise ResultError(f"{path}: no such file; run acstudy bench first") from error
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        reason = f"no entry {error}" if isinstance(error, KeyError) else " ".join(str(error).split())
        raise ResultError(f"{path}: {reason}; not a bench of acstudy; run acstudy bench again or move the file "
                          "away") from error


def _identity(series):
    """What makes a curve: several studies may have asked for parts of it."""
    standing = series["motion"] == "standing"
    scheme = Scheme(model=series["model"], divergence="" if standing else series["divergence"],
                    kernel=series["kernel"], alpha=series.get("alpha"), mu=series.get("mu"), label=series.get("label", ""))
    texts = ("path", "source", "delta", "step", "integrator", "stepping", "motion", "scene", "T", "threads")
    # A scaling study shows its own numbers alone, and so does one that steps in several ways.
    alone = is_scaling(series["study"]) or series["stepping"]
    return (scheme, *(series[name] for name in texts), series["study"] if alone else "")


def is_scaling(study):
    """Whether a study is there for the scaling of run time and not for its errors."""
    return study.startswith("scaling-")


def _curve(identity, group, all_cases):
    scheme, path, source, delta, step, integrator, stepping, motion, scene, T, threads, _ = identity
    indices = dict.fromkeys(i for series in group for i in series["cases"])
    cases = sorted((all_cases[i] for i in indices), key=lambda case: case["N"])

    def column(*names):
        return np.array([_entry(case, names) for case in cases], dtype=float)

    def spread(name):
        return Spread(*(column(name, part) for part in ("median", "minimum", "deviation")))

    return Curve(studies=tuple(dict.fromkeys(series["study"] for series in group)), title=group[0]["title"],
                 scheme=scheme, path=path, source=source, delta_text=delta, step_text=step, integrator=integrator, stepping=stepping,
                 motion=motion, scene=scene, T=T, threads=threads, N=column("N").astype(np.int64), h=column("h"),
                 delta=column("delta"), steps=column("steps").astype(np.int64), stages=column("stages"),
                 error=column("error_linf"), seconds=spread("seconds"), parts={name: spread(name) for name in PARTS},
                 pairs=column("work", "pairs"),
                 runs=np.array([len(case.get("samples", {}).get("seconds", ())) for case in cases]))


def _entry(case, names):
    """The number at a place in a case; NaN where it has none, because it could not be run."""
    for name in names:
        if name not in case and case["failure"]:
            return np.nan
        case = {"failure": "", **case[name]} if isinstance(case[name], dict) else case[name]
    return np.nan if case is None else case
