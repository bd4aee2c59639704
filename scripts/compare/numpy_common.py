"""What both NumPy programs share: kernels, source, time loop, and how they are called.

Sources are Gauss-Legendre rules for all particles at once. Where particles stand still the rates are a sparse matrix,
built once (SciPy).
"""

from dataclasses import dataclass
import json
from pathlib import Path
import time
from typing import Callable

import numpy as np

try:
    from scipy.sparse import csr_array
except ImportError:
    csr_array = None

from scenes import SCENES
import strict_json

TIE = 1 + 1e-11     # a neighbor at exactly the horizon is inside; round-off in a position must not decide
GAUSS_POINTS = 10   # per smooth piece of the kernel: round-off at a horizon of 0.2


class InverseKernel:
    """eta(z) = 1/z on the unit horizon."""
    pieces = ((0.0, 1.0),)

    @staticmethod
    def eta(z):
        return 1 / z

    @staticmethod
    def first_moment(z):
        return z


class CubicSplineKernel:
    """eta(z) = -8 rho'(2 z), rho the cubic B-spline on |zeta| <= 2."""
    pieces = ((0.0, 0.5), (0.5, 1.0))

    @staticmethod
    def eta(z):
        return np.where(z <= 0.5, z * (32 - 48 * z), 16 * (1 - z) ** 2)

    @staticmethod
    def first_moment(z):
        y = 1 - z
        return np.where(z <= 0.5, z * z * z * (32 / 3 - 12 * z), 1 - y * y * y * (16 / 3 - 4 * y))

    @staticmethod
    def mass(z):
        y = 1 - z
        return np.where(z <= 0.5, z * z * (16 - 16 * z), (8 - 16 * y * y * y) / 3)


KERNELS = {"inverse": InverseKernel, "cubic-spline": CubicSplineKernel}


@dataclass(frozen=True)
class Case:
    """A case of the comparison, without what only the driver needs."""
    scene: str
    model: int
    divergence: str
    kernel: str
    source: str
    N: int
    delta: float
    steps: int
    mu: float


def widest_window(x, delta, period):
    """The largest number of neighbors within the horizon on one side; 1 at least."""
    ahead = np.concatenate((x, x[x <= x[0] + delta * TIE] + period))
    return max(1, int(np.max(np.searchsorted(ahead, x + delta * TIE, "right") - np.arange(1, x.size + 1))))


# ------------------------------------------------------------------------------------------------------------- source

def gauss_rule(kernel, delta):
    """Nodes r and weights, times eta^delta(r), of a Gauss-Legendre rule for the integral over (0, delta)."""
    node, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    z = np.concatenate([a + (b - a) * (node + 1) / 2 for a, b in kernel.pieces])
    w = np.concatenate([weight * (b - a) / 2 for a, b in kernel.pieces])
    return z[:, None] * delta, w * kernel.eta(z) / delta


def nonlocal_source(case, scene, rule, x, t):
    """The nonlocal model of (2.8), (2.10), (3.7) or (3.9) applied to the exact solution."""
    r, w = rule
    u, b = scene.u(x, t), scene.b(x)
    f = scene.u_t(x, t) + b * scene.u_x(x, t)
    if case.divergence == "local":
        f += scene.b_prime(x) * u
    if case.model == 1:
        s = np.where(scene.c(x) > b, 1.0, -1.0)
        y = x - s * r
        of_b = b if case.divergence == "local" else scene.b(y)
        return f + s * (w @ ((scene.c(x) - of_b) * u - (scene.c(y) - scene.b(y)) * scene.u(y, t)))
    for s in (1.0, -1.0):
        middle, u_y = x + s * r / 2, scene.u(x + s * r, t)
        b_middle = scene.b(middle)
        flux = (scene.c(middle) - b_middle) * (u + u_y)
        if case.divergence == "nonlocal":
            flux += 2 * b_middle * u
        f += w / 2 @ (s * flux - case.delta * case.mu * (u_y - u) / r)
    return f


# ---------------------------------------------------------------------------------------------------------- time loop

def run(case, rates):
    """The max-norm error at T, after equal steps of forward Euler. `rates`: of a program, see `main`."""
    scene = SCENES[case.scene]
    x0 = np.arange(case.N) * (scene.period / case.N)
    x, u, dt = x0, scene.u(x0, 0.0), scene.T / case.steps
    if scene.flow is None:
        R = rates.standing(case, scene, x)
        for n in range(case.steps):
            u = u + dt * (R @ u + scene.local_source(x, n * dt))
        return np.max(np.abs(u - scene.u(x, scene.T)))

    rate = rates.model1 if case.model == 1 else rates.model2
    rule = gauss_rule(KERNELS[case.kernel], case.delta)
    for n in range(case.steps):
        t = n * dt
        f = scene.local_source(x, t) if case.source == "local" else nonlocal_source(case, scene, rule, x, t)
        u = u + dt * (rate(case, scene, x, u) + f)
        x = scene.flow(x0, (n + 1) * dt)
    return np.max(np.abs(u - scene.u(x, scene.T)))


@dataclass(frozen=True)
class Rates:
    """What a program computes: du/dt of both models without the source, and the matrix of (2.4)."""
    model1: Callable    # of case, scene, x and u
    model2: Callable
    standing: Callable  # of case, scene and x


def main(rates, cases_file, results_file):
    """Runs the cases of a file and writes error and seconds of each to another one."""
    results = []
    for given in json.loads(Path(cases_file).read_text(encoding="utf-8")):
        case = Case(**{name: given[name] for name in Case.__dataclass_fields__})
        if SCENES[case.scene].flow is None and csr_array is None:
            results.append({"left_out": "no SciPy"})
            continue
        started = time.perf_counter()
        error = float(run(case, rates))
        results.append({"error_linf": error, "seconds": time.perf_counter() - started})
    Path(results_file).write_text(strict_json.dumps(results), encoding="utf-8")
