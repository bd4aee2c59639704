"""Upwind differences for u_t + (c u)_x = f, c > 0, on a periodic line. --mistake: c u_x in place of (c u)_x."""
import json
from math import ceil, cos, sin
import sys


def c(x):
    return 1 + sin(x) / 2


def f(x, t):
    """u_t + (c u)_x of u = sin(x - t)."""
    return (c(x) - 1) * cos(x - t) + cos(x) / 2 * sin(x - t)


case = json.load(sys.stdin)
mistake = "--mistake" in sys.argv
x, u, h, T = case["x"], case["u0"], case["h"], case["T"]
steps = ceil(2 * T / h)
dt = T / steps
speed = [c(at) for at in x]
for n in range(steps):
    if mistake:
        rate = [speed[j] * (u[j] - u[j - 1]) / h for j in range(len(x))]
    else:
        rate = [(speed[j] * u[j] - speed[j - 1] * u[j - 1]) / h for j in range(len(x))]
    u = [u[j] + dt * (f(x[j], n * dt) - rate[j]) for j in range(len(x))]
json.dump({"x": x, "u": u}, sys.stdout)
