#!/usr/bin/env python3
"""Model I on particles that stand still, in PySPH: pysph_standing.py CASES.json RESULTS.json

For the cases of standing.toml. PySPH finds the neighbors, keeps their lists and runs the compiled loop over pairs. Its
loops see one pair at a time, in no order. On equal gaps the cell of a neighbor follows from its distance; on moving
particles it ends at the next neighbor, and one would sort every list oneself, so these cases are left out.
"""

import json
import math
from pathlib import Path
import sys
import time

from compyle.config import get_config
import numpy as np
from pysph.base.kernels import CubicSpline
from pysph.base.nnps import DomainManager, LinkedListNNPS
from pysph.base.utils import get_particle_array
from pysph.sph.acceleration_eval import AccelerationEval
from pysph.sph.equation import Equation, Group
from pysph.sph.integrator import Integrator
from pysph.sph.integrator_step import IntegratorStep
from pysph.sph.sph_compiler import SPHCompiler

from scenes import SCENES
import strict_json

TIE = 1 + 1e-11     # a neighbor at exactly the horizon is inside; round-off in a position must not decide
MARGIN = 1e-6       # of the search beyond the horizon: PySPH leaves out what is exactly there


class GhostValues(Equation):
    """Periodic images get the value of their particle; where nothing moves, no new images are needed."""

    def initialize(self, d_idx, d_q, d_master):
        d_q[d_idx] = d_q[d_master[d_idx]]


class UpwindRate(Equation):
    """(2.4) with the inverse kernel on equal gaps, and the local source of the scene."""

    def __init__(self, dest, sources, delta, gap):
        self.delta = delta
        self.horizon = delta * TIE
        self.gap = gap
        super().__init__(dest, sources)

    def initialize(self, d_idx, d_rate, d_x, d_c, t):
        phase = d_x[d_idx] - t
        d_rate[d_idx] = sin(phase) * (1.0 - d_c[d_idx]) + cos(d_x[d_idx]) * cos(phase)

    def loop(self, d_idx, s_idx, d_rate, d_c, s_c, d_q, s_q, XIJ):
        s = 1.0 if d_c[d_idx] > 0.0 else -1.0
        d = s * XIJ[0]
        if d > 0.5 * self.gap and d <= self.horizon:
            outer = self.delta if d + self.gap > self.horizon else d
            W = (outer - d + self.gap) / (self.delta * d)
            d_rate[d_idx] -= s * (d_c[d_idx] * d_q[d_idx] - s_c[s_idx] * s_q[s_idx]) * W


class ForwardEuler(IntegratorStep):
    def stage1(self, d_idx, d_q, d_rate, dt):
        d_q[d_idx] += dt * d_rate[d_idx]


class StandingIntegrator(Integrator):
    def one_timestep(self, t, dt):
        self.compute_accelerations(0, False)
        self.stage1()


def run(case, scene):
    """(error, seconds of the time loop); the error is the largest over the particles at T."""
    gap = scene.period / case["N"]
    x = np.arange(case["N"]) * gap
    particles = get_particle_array(name="fluid", x=x, h=case["delta"] * (1 + MARGIN), c=scene.c(x), q=scene.u(x, 0.0),
                                   rate=0.0)
    particles.add_property("master", type="int", data=np.arange(case["N"], dtype=np.int32))
    equations = [Group([GhostValues("fluid", None)], real=False),
                 Group([UpwindRate("fluid", ["fluid"], case["delta"], gap)])]
    kernel = CubicSpline(dim=1)
    kernel.radius_scale = 1.0
    evaluation = AccelerationEval([particles], equations, kernel)
    integrator = StandingIntegrator(fluid=ForwardEuler())
    SPHCompiler([evaluation], integrator).compile()
    domain = DomainManager(xmin=-0.5 * gap, xmax=scene.period - 0.5 * gap, periodic_in_x=True)
    neighbors = LinkedListNNPS(dim=1, particles=[particles], radius_scale=1.0, domain=domain, cache=True)
    evaluation.set_nnps(neighbors)
    integrator.set_nnps(neighbors)
    neighbors.update()

    dt = scene.T / case["steps"]
    started = time.perf_counter()
    for n in range(case["steps"]):
        integrator.step(n * dt, dt)
    seconds = time.perf_counter() - started
    real = slice(0, case["N"])
    return float(np.max(np.abs(particles.q[real] - scene.u(particles.x[real], scene.T)))), seconds


def main(cases_file, results_file):
    get_config().use_openmp = False
    results = []
    for case in json.loads(Path(cases_file).read_text(encoding="utf-8")):
        error, seconds = run(case, SCENES[case["scene"]])
        results.append({"error_linf": error, "seconds": seconds})
    Path(results_file).write_text(strict_json.dumps(results), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
