"""What a result file says, as plain records: Study > Finding > its points, and its series with an entry per case.

A field is named as it is stored.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from pathlib import Path

from reading.stored import Between, Column


@dataclass(frozen=True)
class Scheme:
    """What is discretized with what: everything of a scheme but the horizon and the steps."""
    model: int          # 1: upwind kernel, 2: renormalized SPH with nonlocal viscosity, 0: an outside program
    divergence: str     # "local" | "nonlocal", empty where particles stand still
    kernel: str
    alpha: float | None  # exponent of the power kernel
    mu: float | None     # viscosity bound of Model II
    label: str = ""      # of an outside program, which has no kernel


@dataclass(frozen=True)
class Scene:
    """What is solved, free of any discretization. `b` and `flow` are empty where the study has none.

    Where no solution is known `u` is empty, and initial values and source are given: `u0`, `f`.
    """
    name: str
    period: float
    T: float
    c: str
    b: str = ""
    u: str = ""
    flow: str = ""
    u0: str = ""
    f: str = ""


@dataclass(frozen=True)
class Cases:
    """The cases of a series, coarse to fine."""
    N: Column
    h: Column
    delta: Column
    dt: Column
    steps: Column
    variable: Column        # value of the theory's variable
    error_linf: Column
    seconds: Column         # time loop, or the case's share of it; median over repeats
    seconds_low: Column
    seconds_high: Column
    repeats: Column
    work_pairs: Column
    work_weight_builds: Column
    work_quadrature_points: Column
    pairwise: Between       # orders in the theory's variable
    bound_largest: Column = None       # longest explicit step over the bound of its lemma; 0, NaN: not bounded
    bound_first_step: Column = None    # first step beyond the bound; 0, NaN: none
    bound_first_time: Column = None
    bound_first_place: Column = None   # left end of the smallest gap then
    error_l1: Column = None            # other norms of the error at T
    error_l2: Column = None
    tolerance: Column = None           # of adaptive steps; 0, NaN: they are not
    rejected: Column = None            # adaptive steps that were taken back, besides `steps`
    last_step: Column = None           # of a run that was given up: its last finite state
    last_time: Column = None           # NaN: the run went to its end
    last_place: Column = None          # position of the particle that gave it away

    def __len__(self):
        return len(self.N)


@dataclass(frozen=True)
class Series:
    """What was run: one scheme along one refinement path."""
    scheme: Scheme
    path: str
    source: str         # which equation the manufactured source makes u solve: "local" | "nonlocal"
    delta_text: str
    step_text: str
    integrator: str
    theory_statement: str
    cases: Cases
    start: str = "uniform"      # where particles stand at first: "uniform", "jittered(0.01, seed 1)", ...
    stepping: str = ""          # integrator and rule of steps, where the study has several
    observed_fitted: float = math.nan   # order of the power law alone, without a correction


@dataclass(frozen=True)
class Points:
    """The measured values of a finding. NaN, and 0 for N: does not apply."""
    N: Column
    h: Column
    delta: Column
    variable: Column        # what the order is in, or what the value is drawn over
    value: Column
    lower: Column           # bounds of the value; infinite where there is none
    upper: Column
    label: tuple = ()       # what each value is of, where that is no number; else empty

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
    variable_name: str  # of the points' variable
    test: str           # "order": vanishes with theory's order; "bounds": every value within [lower, upper]; ...
    theory_order: float
    observed_order: float
    observed_low: float
    observed_high: float
    extrapolated_order: float
    verdict: str
    promised: str       # the verdict if the statement is true
    expected: str       # the verdict that the study demands; another than promised for a negative control
    as_expected: bool
    alarm: bool         # the statement does not hold of the subject, expected or not
    reason: str
    points: Points
    coordinates: dict   # name -> text or number: the conditions that `check` says in words, and what else is known
    remark: str = ""
    also_expected: tuple = ()
    fit: dict = None        # of a surface A h^p + B delta^q: A, B, p, p_low, ..., rms; empty for the other tests
    series: Series = None   # what was run, where the finding is the verdict on a series

    @property
    def control(self):
        """Whether a failure, or an error that settles, is demanded here, to show that the measurement can see one."""
        return self.expected != self.promised or self.promised in ("violated", "stagnates")


@dataclass(frozen=True, eq=False)     # arrays have no hash and no truth
class Study:
    """One result file."""
    file: Path
    name: str
    title: str
    kind: str
    text: str           # the study file, whole
    provenance: dict    # name -> text, in alphabetic order
    scene: Scene        # None: the study has none
    findings: tuple     # what the gate judges
    evidence: tuple     # findings on series that the gate does not judge, where a report shows them

    @property
    def steps_in_several_ways(self):
        """Whether its series compare integrators and steps, and not only schemes."""
        return any(finding.series and finding.series.stepping for finding in self.findings)
