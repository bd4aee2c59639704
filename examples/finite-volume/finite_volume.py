"""Finite volumes for u_t + (c u)_x = f, c > 0, on a periodic line: linear reconstruction, fluxes from the left, Heun."""
import json
import sys

import numpy as np

case = json.load(sys.stdin)
x, u, h, T = np.array(case["x"]), np.array(case["u0"]), case["h"], case["T"]
speed_at_right_face = 1 + np.sin(x + h / 2) / 2


def f(t):
    """u_t + (c u)_x of u = exp(sin(x - t)); the value at the center of a cell is its mean to second order."""
    exact = np.exp(np.sin(x - t))
    return ((np.sin(x) / 2) * np.cos(x - t) + np.cos(x) / 2) * exact


def rate(u, t):
    slope = (np.roll(u, -1) - np.roll(u, 1)) / 2
    flux = speed_at_right_face * (u + slope / 2)
    return f(t) - (flux - np.roll(flux, 1)) / h


steps = int(np.ceil(4 * T / h))
dt = T / steps
for n in range(steps):
    first = u + dt * rate(u, n * dt)
    u = (u + first + dt * rate(first, (n + 1) * dt)) / 2
json.dump({"x": x.tolist(), "u": u.tolist()}, sys.stdout)
