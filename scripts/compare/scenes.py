"""The two scenes of the comparison, as functions of NumPy arrays: what is solved, free of any discretization."""

from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np


@dataclass(frozen=True)
class Scene:
    """Fields of a scene; b, b_prime and flow are None where particles stand still."""
    period: float
    T: float
    c: Callable
    c_prime: Callable
    u: Callable             # of x and t, as are its derivatives
    u_x: Callable
    u_t: Callable
    b: Optional[Callable] = None
    b_prime: Optional[Callable] = None
    flow: Optional[Callable] = None     # of x_0 and t

    def local_source(self, x, t):
        """f = u_t + (c u)_x, with which u solves the local equation."""
        return self.u_t(x, t) + self.c(x) * self.u_x(x, t) + self.c_prime(x) * self.u(x, t)


SCENES = {
    "lee-du-2019": Scene(
        period=2 * np.pi, T=1.0,
        c=lambda x: np.cos(2 * x) / 3, c_prime=lambda x: -2 * np.sin(2 * x) / 3,
        u=lambda x, t: np.cos(x - t), u_x=lambda x, t: -np.sin(x - t), u_t=lambda x, t: np.sin(x - t),
        b=np.sin, b_prime=np.cos,
        flow=lambda x0, t: 2 * np.arctan2(np.sin(x0 / 2) * np.exp(t), np.cos(x0 / 2))),
    "standing": Scene(
        period=2 * np.pi, T=1.0,
        c=lambda x: 0.5 + np.sin(x), c_prime=np.cos,
        u=lambda x, t: np.cos(x - t), u_x=lambda x, t: -np.sin(x - t), u_t=lambda x, t: np.sin(x - t)),
}
