"""What run times and work say: seconds to reach an error, the efficient frontier, the law of cost."""

from dataclasses import dataclass
import math

import numpy as np

TARGETS = (1e-2, 3e-3, 1e-3)
# Where the deviation is a larger part of the median, a time is noise and takes no part in the law of cost.
NOISE = 0.05
FARTHEST = 4.0      # as many times smaller than the finest error may a target be that is extrapolated to
RESAMPLES = 2000


@dataclass(frozen=True)
class Reach:
    """Seconds to reach an error. kind: "between" two levels; "coarsest": already the coarsest level is better, so its
    time is an upper bound; "beyond": extrapolated from the two finest levels; "not": not reached; "none": no level."""
    kind: str
    seconds: float


def reach(curve, target):
    """Seconds that `curve` needs for an error of `target`, by power laws between neighboring levels."""
    good = np.isfinite(curve.error) & (curve.error > 0) & np.isfinite(curve.seconds.median)
    error, seconds = curve.error[good], curve.seconds.median[good]
    if not len(error):
        return Reach("none", math.nan)
    if error[0] <= target:
        return Reach("coarsest", float(seconds[0]))
    for i in range(1, len(error)):
        if error[i] <= target:
            return Reach("between", _on_power_law(error[i - 1:i + 1], seconds[i - 1:i + 1], target))
    falls = len(error) > 1 and error[-1] < error[-2] and seconds[-1] > seconds[-2]
    if falls and error[-1] <= FARTHEST * target:
        return Reach("beyond", _on_power_law(error[-2:], seconds[-2:], target))
    return Reach("not", math.nan)


def _on_power_law(error, seconds, target):
    part = math.log(target / error[0]) / math.log(error[1] / error[0])
    return float(seconds[0] * (seconds[1] / seconds[0]) ** part)


def frontier(cost, error):
    """Which of the points are efficient: no other point has at most its cost and at most its error. Shape [n]."""
    cost, error = np.asarray(cost, dtype=float), np.asarray(error, dtype=float)
    efficient = np.zeros(len(cost), dtype=bool)
    best = math.inf
    for i in np.lexsort((error, cost)):
        if math.isfinite(cost[i]) and error[i] < best:
            efficient[i] = True
            best = error[i]
    return efficient


@dataclass(frozen=True)
class Law:
    """y = C N^a neighbors^b with 95 % intervals of a and b; rms: of the relative deviations of the cases from it."""
    C: float
    a: float
    a_interval: tuple
    b: float
    b_interval: tuple
    rms: float
    cases: int      # that it was fitted to
    left_out: int   # that were noise or had no time


def fit_law(N, neighbors, y, noise=None):
    """The law of cost by least squares of logarithms; None if fewer than five cases determine it.

    The intervals are those of 2000 resamples of the cases, of fixed seed: they contain what a power law that is not
    quite true does to the exponents, as far as the cases show it.
    noise: relative spread of each y; cases above NOISE are left out.
    """
    N, neighbors, y = (np.asarray(values, dtype=float) for values in (N, neighbors, y))
    good = np.isfinite(y) & (y > 0)
    if noise is not None:
        good &= np.asarray(noise) <= NOISE
    A = np.column_stack((np.ones(good.sum()), np.log(N[good]), np.log(neighbors[good])))
    log_y = np.log(y[good])
    if len(log_y) < 5 or np.linalg.matrix_rank(A) < 3:
        return None
    solution = np.linalg.lstsq(A, log_y, rcond=None)[0]
    chosen = np.random.default_rng(1).integers(len(log_y), size=(RESAMPLES, len(log_y)))
    exponents = [np.linalg.lstsq(A[rows], log_y[rows], rcond=None)[0][1:] for rows in chosen
                 if np.linalg.matrix_rank(A[rows]) == 3]
    low, high = np.percentile(exponents, (2.5, 97.5), axis=0)
    rms = math.sqrt(np.mean((A @ solution - log_y) ** 2))
    return Law(math.exp(solution[0]), solution[1], (low[0], high[0]), solution[2], (low[1], high[1]), rms,
               len(log_y), len(y) - len(log_y))


def laws(curves):
    """{(scheme, steps): (law of seconds, law of pairs)} over all paths of a scheme with the same rule of steps."""
    groups = {}
    for curve in curves:
        groups.setdefault((curve.scheme, curve.step_text, curve.integrator, curve.T), []).append(curve)
    found = {}
    for (scheme, step, *_), group in groups.items():
        N, neighbors, seconds, deviation, pairs = (
            np.concatenate([of(curve) for curve in group])
            for of in (lambda c: c.N, lambda c: c.neighbors, lambda c: c.seconds.median, lambda c: c.seconds.deviation,
                       lambda c: c.work["pairs"]))
        found[scheme, step] = (fit_law(N, neighbors, seconds, deviation / seconds), fit_law(N, neighbors, pairs))
    return found
