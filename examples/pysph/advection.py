"""u_t + u_x = 0 by PySPH's gradient of a cubic spline on standing particles, and classical Runge-Kutta steps."""
import json
import os
import sys

# PySPH writes to stdout while it compiles; that is for the answer alone.
answer = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)

import numpy as np
from pysph.base.kernels import CubicSpline
from pysph.base.utils import get_particle_array
from pysph.sph.equation import Equation
from pysph.tools.sph_evaluator import SPHEvaluator


class Gradient(Equation):
    """dq_i = sum_j m_j/rho_j (q_j - q_i) dW_ij/dx_i"""

    def initialize(self, d_idx, d_dq):
        d_dq[d_idx] = 0.0

    def loop(self, d_idx, s_idx, d_q, s_q, d_dq, s_m, s_rho, DWIJ):
        d_dq[d_idx] += s_m[s_idx] / s_rho[s_idx] * (s_q[s_idx] - d_q[d_idx]) * DWIJ[0]


case = json.load(sys.stdin)
x, u, h, T, N = np.array(case["x"]), np.array(case["u0"]), case["h"], case["T"], case["N"]
# Images on both sides make the line periodic.
index = np.arange(-int(case["delta"] / h) - 2, N + int(case["delta"] / h) + 2)
inner = slice(-index[0], N - index[0])
places = x[index % N] + case["period"] * (index // N)
particles = get_particle_array(name="wave", x=places, m=np.full(len(index), h), rho=np.ones(len(index)),
                               h=np.full(len(index), case["delta"] / 2), q=u[index % N], dq=np.zeros(len(index)))
evaluator = SPHEvaluator([particles], [Gradient(dest="wave", sources=["wave"])], dim=1, kernel=CubicSpline(dim=1))


def rate(u):
    particles.q[:] = u[index % N]
    evaluator.evaluate()
    return -particles.dq[inner]


steps = int(np.ceil(2 * T / h))
dt = T / steps
for n in range(steps):
    k1 = rate(u)
    k2 = rate(u + dt / 2 * k1)
    k3 = rate(u + dt / 2 * k2)
    k4 = rate(u + dt * k3)
    u = u + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
json.dump({"x": x.tolist(), "u": u.tolist()}, answer)
answer.close()
