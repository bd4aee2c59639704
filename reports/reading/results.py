"""Result files of acstudy, read into plain records: Study > Series > an array entry per case; Study > Finding > points.

Reading only: nothing here computes, draws or writes. The layout is the format "acstudy-1" that `acstudy run` writes.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
import math
import re

import h5py
import numpy as np

FORMAT = "acstudy-1"
CONVERGENCE = "convergence"
# Kinds whose series a report shows; the others have theirs as evidence of findings, and reading takes a while.
_WITH_SERIES = (CONVERGENCE, "map")


class ResultError(Exception):
    """A file that cannot be read as a result of acstudy; the text is one line: file, what is wrong, remedy."""


@dataclass(frozen=True)
class Scheme:
    """What is discretized with what: everything of a scheme but the horizon and the steps."""
    model: int          # 1: upwind kernel, 2: renormalized SPH with nonlocal viscosity
    divergence: str     # "local" | "nonlocal", empty where particles stand still
    kernel: str
    alpha: float | None  # exponent of the power kernel
    mu: float | None     # viscosity bound of Model II


@dataclass(frozen=True)
class Scene:
    """What is solved, free of any discretization. `b` and `flow` are empty where the study has none.

    Where no solution is known `u` is empty, and initial values and source are given: `u0`, `f`.
    """
    name: str
    period: float
    T: float
    c: str
    b: str
    u: str
    flow: str
    u0: str = ""
    f: str = ""


@dataclass(frozen=True)
class Cases:
    """The cases of a series, coarse to fine: every member is an array [n], but `pairwise`, which is [n - 1]."""
    N: np.ndarray
    h: np.ndarray
    delta: np.ndarray
    dt: np.ndarray
    steps: np.ndarray
    variable: np.ndarray        # value of the theory's variable
    error_linf: np.ndarray
    seconds: np.ndarray         # time loop, or the case's share of it; median over repeats
    seconds_low: np.ndarray
    seconds_high: np.ndarray
    repeats: np.ndarray
    work_pairs: np.ndarray
    work_weight_builds: np.ndarray
    work_quadrature_points: np.ndarray
    bound_largest: np.ndarray       # longest explicit step over the bound of its lemma; 0, NaN: not bounded
    bound_first_step: np.ndarray    # first step beyond the bound; 0, NaN: none
    bound_first_time: np.ndarray
    bound_first_place: np.ndarray   # left end of the smallest gap then
    last_step: np.ndarray           # of a run that was given up: its last finite state
    last_time: np.ndarray           # NaN: the run went to its end
    last_place: np.ndarray          # position of the particle that gave it away
    pairwise: np.ndarray        # orders between neighboring levels, in the theory's variable

    def __len__(self):
        return len(self.N)


@dataclass(frozen=True)
class Series:
    """One scheme along one refinement path, with the theory's claim and the verdict. NaN: not available."""
    scheme: Scheme
    path: str
    source: str         # which equation the manufactured source makes u solve: "local" | "nonlocal"
    delta_text: str
    step_text: str
    integrator: str
    start: str          # where particles stand at first: "uniform", "jittered(0.01, seed 1)", ...
    stepping: str       # integrator and rule of steps, where the study has several; else empty
    theory_variable: str
    theory_order: float
    theory_statement: str
    observed_order: float
    observed_low: float
    observed_high: float
    extrapolated_order: float
    fitted_order: float     # of the power law alone, without a correction
    fitted_low: float
    fitted_high: float
    window: tuple           # first and last level that the fits use, counted from 1
    leave_one_out: float    # largest change of the fitted order if one level is left out
    leave_one_out_level: float
    floor: float            # F of error = C v^p + F
    verdict: str
    expected: str
    as_expected: bool
    reason: str
    cases: Cases


@dataclass(frozen=True)
class Points:
    """The measured values of a finding: every member is an array [n]. NaN, and 0 for N: does not apply."""
    N: np.ndarray
    h: np.ndarray
    delta: np.ndarray
    variable: np.ndarray        # what the order is in, or what the value is drawn over
    value: np.ndarray
    lower: np.ndarray           # bounds of the value; infinite where there is none
    upper: np.ndarray
    label: tuple = ()           # what each value is of, where that is no number; else empty

    def __len__(self):
        return len(self.value)


@dataclass(frozen=True)
class Finding:
    """One statement of theory, what was measured, and whether the two agree. NaN: not available."""
    statement: str
    claim: str
    subject: str
    check: str
    quantity: str
    variable: str       # name of the points' variable
    remark: str         # may be empty
    test: str           # "order": vanishes with theory's order; "bounds": every value within [lower, upper]; ...
    theory_order: float
    observed_order: float
    observed_low: float
    observed_high: float
    extrapolated_order: float
    verdict: str
    promised: str       # the verdict if the statement is true
    expected: str       # the verdict that the study demands; another than promised for a negative control
    also_expected: tuple
    as_expected: bool
    alarm: bool         # the statement does not hold of the subject, expected or not
    reason: str
    points: Points
    fit: dict           # of a surface A h^p + B delta^q: A, B, p, p_low, ..., rms; empty for the other tests

    @property
    def control(self):
        """Whether a failure, or an error that settles, is demanded here, to show that the measurement can see one."""
        return self.expected != self.promised or self.promised in ("violated", "stagnates")


@dataclass(frozen=True)
class Study:
    """One result file."""
    file: Path
    name: str
    title: str
    kind: str           # "convergence": judged by its series; every other kind by its findings
    text: str           # the study file, whole
    provenance: dict    # name -> text, in alphabetic order
    scene: Scene        # None: the study has none
    series: tuple       # empty where a report shows findings alone
    findings: tuple

    @property
    def judged(self):
        """What the gate judges: the series of a convergence study, the findings of any other."""
        return self.series if self.kind == CONVERGENCE else self.findings

    @property
    def steps_in_several_ways(self):
        """Whether its series compare integrators and steps, and not only schemes."""
        return any(series.stepping for series in self.series)


def read_study(path):
    """The study in the result file `path`; ResultError if the file is missing, damaged or of another format."""
    path = Path(path)
    try:
        with h5py.File(path, "r") as file:
            return _study(path, file)
    except OSError as error:
        if not path.is_file():
            raise ResultError(f"{path}: no such file; run the study first") from error
        reason = " ".join(str(error).split()) or type(error).__name__
        raise ResultError(f"{path}: not a readable HDF5 file ({reason}); "
                          "run the study again or move the file away") from error
    except (KeyError, RuntimeError, TypeError, ValueError) as error:
        reason = " ".join(str(error).strip("'\"").split())
        raise ResultError(f"{path}: {reason}; run the study again") from error


def _study(path, file):
    found = _text(file, "format", "")
    if found != FORMAT:
        raise ResultError(f'{path}: format = "{found}"; not a result file of acstudy; '
                          f'write one of format "{FORMAT}" with "acstudy run"')
    name = _text(file, "study")
    # The name becomes file names beside the report: it must not lead out of the folder.
    if not re.fullmatch(r"[a-z0-9-]+", name):
        raise ResultError(f'{path}: study = "{name}"; a study is named by [a-z0-9-]+; rename it and run it again')
    provenance = file["provenance"]
    findings = file["findings"] if "findings" in file else {}
    kind = _text(file, "kind", CONVERGENCE)
    series = file["series"] if "series" in file and kind in _WITH_SERIES else {}
    return Study(
        file=path,
        name=name,
        title=_text(file, "title"),
        kind=kind,
        text=_text(file, "study_text", ""),
        provenance={key: _text(provenance, key) for key in sorted(provenance.attrs)},
        scene=_scene(file["scene"]) if "scene" in file or kind == CONVERGENCE else None,
        series=tuple(_series(series[key]) for key in sorted(series)),
        findings=tuple(_finding(findings[key]) for key in sorted(findings)))


def _scene(group):
    return Scene(name=_text(group, "name"), period=_number(group, "period"), T=_number(group, "T"),
                 c=_text(group, "c"), b=_text(group, "b", ""), u=_text(group, "u", ""), flow=_text(group, "flow", ""),
                 u0=_text(group, "u0", ""), f=_text(group, "f", ""))


def _series(group):
    standing = _text(group, "motion") == "standing"  # b = 0, so both divergence forms are one
    scheme = Scheme(model=int(_number(group, "model")), divergence="" if standing else _text(group, "divergence"),
                    kernel=_text(group, "kernel"), alpha=_optional(group, "alpha"), mu=_optional(group, "mu"))
    texts = ("path", "source", "delta_text", "step_text", "integrator", "theory_variable", "theory_statement",
             "verdict", "expected", "reason")
    numbers = ("theory_order", "observed_order", "observed_low", "observed_high", "extrapolated_order")
    # Files of older versions lack these.
    later = {"fitted_order": "fitted", "fitted_low": "fitted_low", "fitted_high": "fitted_high",
             "leave_one_out": "leave_one_out", "leave_one_out_level": "leave_one_out_level", "floor": "floor"}
    cases = _cases(group)
    window = (int(_number(group, "observed_window_first", 1)), int(_number(group, "observed_window_last", len(cases))))
    return Series(scheme=scheme, window=window, as_expected=bool(_number(group, "as_expected")), cases=cases,
                  stepping=_text(group, "stepping", ""), start=_text(group, "start", "uniform"),
                  **{name: _text(group, name) for name in texts},
                  **{name: _number(group, name) for name in numbers},
                  **{name: _number(group, f"observed_{stored}", math.nan) for name, stored in later.items()})


def _finding(group):
    texts = ("statement", "claim", "subject", "check", "quantity", "test", "promised", "expected", "verdict", "reason")
    numbers = ("theory_order", "observed_order", "observed_low", "observed_high", "extrapolated_order")
    points = _columns(group, Points, {"N"}, without={"label"})
    labels = tuple(_text(group, "labels", "").splitlines())
    if labels and len(labels) != len(points["N"]):
        raise ValueError(f"{group.name}: {len(labels)} labels, but {len(points['N'])} points")
    return Finding(
        **{name: _text(group, name) for name in texts},
        **{name: _number(group, name) for name in numbers},
        **{name: bool(_number(group, name)) for name in ("as_expected", "alarm")},
        variable=_text(group, "variable_name"),
        remark=_text(group, "remark", ""),
        also_expected=tuple(_text(group, "also_expected", "").split()),
        points=Points(**points, label=labels),
        fit={name.removeprefix("surface_"): _number(group, name) for name in sorted(group.attrs)
             if name.startswith("surface_")})


def _cases(group):
    integers = {"N", "steps", "repeats", "work_pairs", "work_weight_builds", "work_quadrature_points"}
    later = {name for name in Cases.__dataclass_fields__ if name.startswith(("bound_", "last_"))}
    return Cases(**_columns(group, Cases, integers, between={"pairwise"}, later=later))


def _columns(group, record, integers, between=frozenset(), without=frozenset(), later=frozenset()):
    """The data sets named as the fields of `record`, all as long as N; one shorter those `between` two entries.

    Those that came `later` are NaN where a file of an older version lacks them.
    """
    arrays = {}
    for name in (name for name in record.__dataclass_fields__ if name not in without):
        try:
            values = _values(group, name)
        except KeyError:
            if name not in later:
                raise KeyError(f"{group.name}: no dataset {name}") from None
            values = np.full(len(arrays["N"]), math.nan)
        arrays[name] = values.astype(np.int64 if name in integers else float)
    n = len(arrays["N"])
    for name, values in arrays.items():
        expected = max(n - 1, 0) if name in between else n
        if values.shape != (expected,):
            raise ValueError(f"{group.name}/{name}: shape {values.shape}, but {expected} entries belong to N of {n}")
    return arrays


def _values(group, name):
    """A data set as an array of at least one dimension: by the lower interface of h5py, in a third of the time."""
    data = h5py.h5d.open(group.id, name.encode())
    values = np.empty(data.shape, data.dtype)
    data.read(h5py.h5s.ALL, h5py.h5s.ALL, values)
    return np.atleast_1d(values)


def _attribute(group, name, default):
    try:    # asking first whether it is there would take as long again
        return group.attrs[name]
    except KeyError:
        if default is None:
            raise KeyError(f"{group.name}: no attribute {name}") from None
        return default


def _text(group, name, default=None):
    value = _attribute(group, name, default)
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _number(group, name, default=None):
    return float(np.asarray(_attribute(group, name, default)).item())


def _optional(group, name):
    value = _number(group, name, math.nan)
    return None if math.isnan(value) else value
