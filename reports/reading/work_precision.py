"""What run times and work say: seconds to reach an error, the efficient frontier, the law of cost."""

from dataclasses import dataclass
import math

import numpy as np

TARGETS = (1e-2, 3e-3, 1e-3)
# Errors for which the cheapest run is named.
WANTED = sorted((float(f"{step}e{power}") for power in range(-9, 1) for step in (1, 3)), reverse=True)
# A time takes no part in the law of cost if its deviation is a larger part of the median, or if it is shorter: there
# the set-up of a run shows.
NOISE, SHORTEST = 0.05, 2e-3
DISTURBED = 0.2     # the part of the times that deviate so on a machine which does something else as well
FARTHEST = 4.0      # times the finest N: how far errors are extrapolated
RESAMPLES = 2000


def target_text(target):
    return f"{target:.0e}".replace("e-0", "e-")


@dataclass(frozen=True)
class Reach:
    """Seconds to reach an error. kind: "between" two levels; "coarsest": already the coarsest level is better, so its
    time is an upper bound; "beyond": extrapolated from the two finest levels; "not": not reached; "none": no level."""
    kind: str
    seconds: float


def reach(curve, target):
    """Seconds that `curve` needs for an error of `target`, by power laws between neighboring levels."""
    good = np.isfinite(curve.error) & (curve.error > 0) & np.isfinite(curve.seconds.median)
    error, seconds, N = curve.error[good], curve.seconds.median[good], curve.N[good]
    if not len(error):
        return Reach("none", math.nan)
    if error[0] <= target:
        return Reach("coarsest", float(seconds[0]))
    for i in range(1, len(error)):
        if error[i] <= target:
            return Reach("between", _on_power_law(error[i - 1:i + 1], seconds[i - 1:i + 1], target))
    falls = len(error) > 1 and error[-1] < error[-2] and seconds[-1] > seconds[-2]
    if falls and _on_power_law(error[-2:], N[-2:], target) <= FARTHEST * N[-1]:
        return Reach("beyond", _on_power_law(error[-2:], seconds[-2:], target))
    return Reach("not", math.nan)


def _on_power_law(error, values, target):
    """The value at an error of `target`, of a power law through two levels."""
    part = math.log(target / error[0]) / math.log(error[1] / error[0])
    return float(values[0] * (values[1] / values[0]) ** part)


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


def disturbed(curves):
    """(how many times of cases have too large a deviation to take part in the law of cost, how many there are)."""
    seconds, deviation = (np.concatenate([of(curve) for curve in curves] or [np.empty(0)])
                          for of in (lambda c: c.seconds.median, lambda c: c.seconds.deviation))
    timed = np.isfinite(seconds) & (seconds >= SHORTEST)
    return int(np.sum(timed & (deviation > NOISE * seconds))), int(np.sum(timed))


def cheapest(runs):
    """{run: the errors of WANTED that it is the cheapest to reach}, the largest error first; a run is (cost, error, ...)."""
    if not runs:
        return {}
    efficient = frontier([run[0] for run in runs], [run[1] for run in runs])
    best = sorted(run for run, is_efficient in zip(runs, efficient) if is_efficient)
    picks = {}
    for wanted in (error for error in WANTED if best and best[-1][1] <= error <= 2 * best[0][1]):
        picks.setdefault(next(run for run in best if run[1] <= wanted), []).append(wanted)
    return picks


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


def fit_law(N, neighbors, y, use=True):
    """The law of cost by least squares of logarithms; None if fewer than five cases determine it.

    The intervals are those of 2000 resamples of the cases, of fixed seed: they contain what a power law that is not
    quite true does to the exponents, as far as the cases show it.
    use: which cases take part, where not all do; shape [n].
    """
    N, neighbors, y = (np.asarray(values, dtype=float) for values in (N, neighbors, y))
    good = np.isfinite(y) & (y > 0) & use
    A = np.column_stack((np.ones(good.sum()), np.log(N[good]), np.log(neighbors[good])))
    log_y = np.log(y[good])
    if len(log_y) < 5 or np.linalg.matrix_rank(A) < 3:
        return None
    solution = np.linalg.lstsq(A, log_y, rcond=None)[0]
    chosen = np.random.default_rng(1).integers(len(log_y), size=(RESAMPLES, len(log_y)))
    chosen = chosen[np.linalg.matrix_rank(A[chosen]) == 3]
    exponents = (np.linalg.pinv(A[chosen]) @ log_y[chosen][..., None])[:, 1:, 0]
    low, high = np.percentile(exponents, (2.5, 97.5), axis=0)
    rms = math.sqrt(np.mean((A @ solution - log_y) ** 2))
    return Law(math.exp(solution[0]), solution[1], (low[0], high[0]), solution[2], (low[1], high[1]), rms,
               len(log_y), len(y) - len(log_y))


@dataclass(frozen=True)
class Prices:
    """seconds = setup + per_update N steps stages + per_pair pairs; rms: of the relative deviations from it."""
    setup: float
    per_update: float
    per_pair: float
    rms: float


def fit_prices(updates, pairs, seconds, use=True):
    """What a run, an update of a particle and a pair cost, by least squares of relative deviations; None if fewer than
    five cases determine it. All cases take part but those without a time, short ones too: the set-up is a price."""
    updates, pairs, seconds = (np.asarray(values, dtype=float) for values in (updates, pairs, seconds))
    good = np.isfinite(seconds) & (seconds > 0) & use
    A = np.column_stack((np.ones(good.sum()), updates[good], pairs[good])) / seconds[good, None]
    scale = np.linalg.norm(A, axis=0)
    if good.sum() < 5 or np.linalg.matrix_rank(A / scale) < 3:
        return None
    solution = np.linalg.lstsq(A / scale, np.ones(good.sum()), rcond=None)[0] / scale
    return Prices(*solution, math.sqrt(np.mean((A @ solution - 1.0) ** 2)))


@dataclass(frozen=True)
class Cost:
    """What the cases of a scheme with one rule of steps say of its cost. None: they do not determine it."""
    seconds: Law
    pairs: Law
    prices: Prices


def costs(curves):
    """{(scheme, steps): Cost} over all paths of a scheme with the same rule of steps.

    Paths with a nonlocal source are left out: to sum it is work that depends on the horizon in another way. So are
    outside programs, of whose work nothing is known.
    """
    groups = {}
    for curve in curves:
        if curve.source == "local" and not curve.scheme.label:
            groups.setdefault((curve.scheme, curve.step_text, curve.integrator, curve.T), []).append(curve)
    found = {}
    for (scheme, step, *_), group in groups.items():
        N, neighbors, seconds, deviation, pairs, updates = (
            np.concatenate([of(curve) for curve in group])
            for of in (lambda c: c.N, lambda c: c.neighbors, lambda c: c.seconds.median, lambda c: c.seconds.deviation,
                       lambda c: c.pairs, lambda c: c.N * c.steps * c.stages))
        quiet = deviation <= NOISE * seconds
        found[scheme, step] = Cost(fit_law(N, neighbors, seconds, quiet & (seconds >= SHORTEST)),
                                   fit_law(N, neighbors, pairs), fit_prices(updates, pairs, seconds, quiet))
    return found
