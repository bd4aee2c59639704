#!/usr/bin/env python3
"""The cases in NumPy, tuned: numpy_views.py CASES.json RESULTS.json

Every time step is a handful of operations on whole arrays of pairs, shape [K, N]: row k - 1 has neighbor k of all
particles. Neighbors are shifted views of an array with ghosts, so nothing is gathered, and what both particles of a
pair need is computed once.
"""

import sys

import numpy as np
from numpy.lib.stride_tricks import as_strided, sliding_window_view

from numpy_common import KERNELS, Rates, TIE, csr_array, main, widest_window


# ---------------------------------------------------------------------------------------------------------- neighbors

def ghosted(a, K, jump=0):
    """`a` with K periodic images on each side; `jump` is added per period."""
    return np.concatenate((a[-K:] - jump, a, a[:K] + jump))


def neighbors(a, K, s, part=slice(None), jump=0):
    """a_{j - s k} as a view of shape [K, n], k = 1 .. K, for the particles of `part`."""
    rows = sliding_window_view(ghosted(a, K, jump), a.size)
    return (rows[:K][::-1] if s > 0 else rows[K + 1:])[:, part]


def cells(inside, d, delta, antiderivative):
    """Integrals over the cells that end at the distances d_k, the last one reaching to the horizon; shape of `d`.

    `inside`: the antiderivative at d_k/delta, or that at 1 beyond the horizon.
    """
    outer = np.array(inside)
    outer[:-1][d[1:] > delta * TIE] = antiderivative(1.0)
    outer[-1] = antiderivative(1.0)
    outer[1:] -= outer[:-1].copy()
    return outer


# -------------------------------------------------------------------------------------------------------------- rates

def upwind_weights(kernel, delta, d):
    """W_k of Model I, shape of the distances d_k."""
    return cells(kernel.first_moment(np.minimum(d / delta, 1)), d, delta, kernel.first_moment) / d


def same_side(c_hat):
    """(s, particles): runs of particles that look left (s = +1, where c_hat > 0) or right (s = -1)."""
    left = c_hat > 0
    ends = [0, *(np.flatnonzero(np.diff(left)) + 1), c_hat.size]
    return [(1 if left[i] else -1, slice(i, k)) for i, k in zip(ends, ends[1:])]


def model1_rate(case, scene, x, u):
    """(2.9) or (2.11), without the source."""
    kernel, K = KERNELS[case.kernel], widest_window(x, case.delta, scene.period)
    c, b = scene.c(x), scene.b(x)
    c_hat = c - b
    flux = c_hat * u
    rate = np.empty_like(u)
    for s, part in same_side(c_hat):
        d = s * (x[part] - neighbors(x, K, s, part, scene.period))
        W = upwind_weights(kernel, case.delta, d)
        transported = np.einsum("kj,kj->j", W, neighbors(flux, K, s, part))
        if case.divergence == "local":
            rate[part] = -s * (flux[part] * W.sum(0) - transported)
        else:
            of_b = np.einsum("kj,kj->j", W, neighbors(b, K, s, part))
            rate[part] = -s * (u[part] * (c[part] * W.sum(0) - of_b) - transported)
    if case.divergence == "local":
        rate -= scene.b_prime(x) * u
    return rate


def of_left_pairs(of_pairs, K, N):
    """Values of the pairs (j - k, j), from those of the pairs (j, j + k), shape [K, K + N], which begin at j = -K."""
    row, column = of_pairs.strides
    return as_strided(of_pairs[:, K - 1:], (K, N), (row - column, column), writeable=False)


def model2_rate(case, scene, x, u):
    """(3.8) or (3.10), without the source; pairs of all particles are looked at from the left one."""
    kernel, K, N, delta = KERNELS[case.kernel], widest_window(x, case.delta, scene.period), x.size, case.delta
    windows = sliding_window_view(ghosted(x, K, scene.period), N + K)
    d = windows[1:] - windows[0]
    midpoint = 0.5 * (windows[1:] + windows[0])
    inside = kernel.mass(np.minimum(d / delta, 1))
    c_hat = scene.c(midpoint) - scene.b(midpoint)
    b = scene.b(midpoint) if case.divergence == "nonlocal" else None

    moment = np.zeros(N)
    A, D, B = np.zeros(N), np.zeros(N), np.zeros(N)
    reach = np.full(N, delta)
    for s in (1, -1):
        seen = (lambda a: of_left_pairs(a, K, N)) if s > 0 else (lambda a: a[:, K:])
        distance, u_i = seen(d), neighbors(u, K, s)
        W = cells(seen(inside), distance, delta, kernel.mass)
        moment += np.einsum("kj,kj->j", W, distance)
        A -= s * np.einsum("kj,kj->j", W * seen(c_hat), u + u_i)
        D += np.einsum("kj,kj->j", W / distance, u_i - u)
        if b is not None:
            B -= s * np.einsum("kj,kj->j", W, seen(b))
        np.maximum(reach, distance[0], out=reach)
    rate = (case.mu * reach * D - A) / moment
    return rate - (scene.b_prime(x) if b is None else 2 * B / moment) * u


def standing_rate(case, scene, x):
    """(2.4) as a sparse matrix, without the source."""
    kernel, K, c = KERNELS[case.kernel], widest_window(x, case.delta, scene.period), scene.c(x)
    rows, columns, entries = [], [], []
    numbers = np.arange(x.size)
    for s, part in same_side(c):
        W = upwind_weights(kernel, case.delta, s * (x[part] - neighbors(x, K, s, part, scene.period)))
        j, i = numbers[part], neighbors(numbers, K, s, part)
        rows += [j, np.broadcast_to(j, i.shape)]
        columns += [j, i]
        entries += [-s * c[j] * W.sum(0), s * c[i] * W]
    values, row, column = (np.concatenate([np.ravel(part) for part in parts]) for parts in (entries, rows, columns))
    return csr_array((values, (row, column)), shape=(x.size, x.size))


RATES = Rates(model1_rate, model2_rate, standing_rate)

if __name__ == "__main__":
    main(RATES, *sys.argv[1:])
