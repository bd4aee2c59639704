#!/usr/bin/env python3
"""The cases in NumPy, written down as printed: numpy_pairs.py CASES.json RESULTS.json

Every time step is a handful of operations on whole arrays of pairs, shape [N, K]: row j has the neighbors of particle
j, gathered by an array of their numbers; what is beyond the horizon has weight zero.
"""

import sys

import numpy as np

from numpy_common import KERNELS, Rates, TIE, csr_array, main, widest_window


def neighbors(x, K, s, period):
    """Numbers of the particles j - s k, k = 1 .. K, and their distances d_k, shapes [N, K]. `s` is 1, -1 or [N, 1]."""
    N = x.size
    j = np.arange(N)[:, None] - s * np.arange(1, K + 1)
    i = j % N
    return i, s * (x[:, None] - (x[i] + period * (j // N)))


def cells(antiderivative, d, delta):
    """Integrals over the cells that end at the distances d_k, the last one reaching to the horizon; shape of `d`."""
    inside = np.sum(d <= delta * TIE, axis=1)
    last = np.maximum(inside, 1)[:, None]
    number = np.arange(1, d.shape[1] + 1)
    outer = np.where(number < last, antiderivative(np.minimum(d / delta, 1)), antiderivative(1.0))
    return np.where(number <= last, np.diff(outer, axis=1, prepend=0.0), 0.0)


def model1_rate(case, scene, x, u):
    """(2.9) or (2.11), without the source."""
    kernel, c, b = KERNELS[case.kernel], scene.c(x), scene.b(x)
    c_hat = c - b
    s = np.where(c_hat > 0, 1, -1)
    i, d = neighbors(x, widest_window(x, case.delta, scene.period), s[:, None], scene.period)
    W = cells(kernel.first_moment, d, case.delta) / d
    flux = c_hat * u
    if case.divergence == "local":
        return -scene.b_prime(x) * u - s * np.sum((flux[:, None] - flux[i]) * W, axis=1)
    return -s * np.sum(((c[:, None] - b[i]) * u[:, None] - flux[i]) * W, axis=1)


def model2_rate(case, scene, x, u):
    """(3.8) or (3.10), without the source."""
    kernel, K, delta = KERNELS[case.kernel], widest_window(x, case.delta, scene.period), case.delta
    moment, A, D, B, reach = 0.0, 0.0, 0.0, 0.0, delta
    for s in (1, -1):
        i, d = neighbors(x, K, s, scene.period)
        W = cells(kernel.mass, d, delta)
        midpoint = x[:, None] - s * d / 2
        b = scene.b(midpoint)
        moment += np.sum(d * W, axis=1)
        A -= s * np.sum((scene.c(midpoint) - b) * (u[:, None] + u[i]) * W, axis=1)
        D += np.sum((u[i] - u[:, None]) / d * W, axis=1)
        if case.divergence == "nonlocal":
            B -= s * np.sum(2 * b * W, axis=1)
        reach = np.maximum(reach, d[:, 0])
    B = B / moment if case.divergence == "nonlocal" else scene.b_prime(x)
    return case.mu * reach * D / moment - A / moment - B * u


def standing_rate(case, scene, x):
    """(2.4) as a sparse matrix, without the source."""
    kernel, c, N = KERNELS[case.kernel], scene.c(x), x.size
    s = np.where(c > 0, 1, -1)[:, None]
    i, d = neighbors(x, widest_window(x, case.delta, scene.period), s, scene.period)
    W = s * cells(kernel.first_moment, d, case.delta) / d
    j = np.arange(N)
    entries = np.concatenate((-c * W.sum(1), np.ravel(c[i] * W)))
    rows, columns = np.concatenate((j, np.repeat(j, d.shape[1]))), np.concatenate((j, np.ravel(i)))
    return csr_array((entries, (rows, columns)), shape=(N, N))


RATES = Rates(model1_rate, model2_rate, standing_rate)

if __name__ == "__main__":
    main(RATES, *sys.argv[1:])
