"""Manufactured problems u_t + (c u)_x = f: fields, exact solution, source."""

from __future__ import annotations

import json
import os
from pathlib import Path
import tempfile
from typing import Any, Callable, Mapping, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from acstudy.program import ask


class Scene:
    """A problem on a periodic interval, by name, from the [scene] of a study file, or by its fields.

        Scene("lee-du-2019")
        Scene("study.toml")
        Scene(period="2*pi", T=1, c="1 + cos(x)/2", b="1/2", u="sin(x - t)")

    Fields are numbers or expressions in x and t, as in study files; without b particles stand still. InputError if the
    scene is refused. The methods take numbers or arrays of points x, any shape, and give an array of that shape.
    """

    period: float  # length of the interval
    T: float       # final time

    def __init__(self, scene: Union[str, os.PathLike[str], None] = None, **fields: Any):
        if (scene is None) != bool(fields):
            raise TypeError("a scene is given by its name, by a study file, or by its fields; write one of them")
        self._scene = "scene.toml" if scene is None else os.fspath(scene)
        self._text = "[scene]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in fields.items())
        self._given = scene is None
        self._codes: dict[tuple[str, ...], dict[str, Any]] = {}
        self.period, self.T = (self._code()[name] for name in ("period", "final_time"))

    def c(self, x: ArrayLike) -> np.ndarray:
        """Advection velocity."""
        return self._function("c")(np.asarray(x, float))

    def b(self, x: ArrayLike) -> np.ndarray:
        """Velocity of the particles, 0 where they stand still."""
        return self._function("b")(np.asarray(x, float))

    def u(self, x: ArrayLike, t: float) -> np.ndarray:
        """Exact solution. ValueError where none is known."""
        return self._function("u")(np.asarray(x, float), t)

    def u0(self, x: ArrayLike) -> np.ndarray:
        """Solution at t = 0."""
        return self._function("u0")(np.asarray(x, float)) if "u0" in self._code() else self.u(x, 0.0)

    def source(self, x: ArrayLike, t: float, model: Optional[int] = None, *, divergence: Optional[str] = None,
               kernel: Union[str, Mapping[str, Any], None] = None, delta: Optional[float] = None,
               mu: Optional[float] = None) -> np.ndarray:
        """The f that makes u exact: of the PDE, or of a nonlocal model at a horizon.

        model: 1 or 2. divergence: "local" or "nonlocal", where particles move. kernel: a name, or a mapping such as
        {"name": "power", "alpha": 0.5}. delta: horizon, below half the period. mu: viscosity bound of Model II,
        max |c - b| by default. InputError if these do not name a model.
        """
        if kernel is not None and not isinstance(kernel, str):
            kernel = "{ " + ", ".join(f"{key} = {json.dumps(value)}" for key, value in kernel.items()) + " }"
        options = {"--model": model, "--divergence": divergence, "--kernel": kernel, "--delta": delta, "--mu": mu}
        words = [word for option, value in options.items() if value is not None for word in (option, str(value))]
        code = self._code("--source", "nonlocal", *words) if words else self._code()
        return code["f"](np.asarray(x, float), t)

    def _function(self, name: str) -> Callable[..., np.ndarray]:
        try:
            return self._code()[name]
        except KeyError:
            raise ValueError(f"{self._scene}: no exact solution is known; u0 and source are") from None

    def _code(self, *source: str) -> dict[str, Any]:
        """What the Python code of the program defines."""
        if source not in self._codes:
            with tempfile.TemporaryDirectory() as folder:
                Path(folder, "scene.toml").write_text(self._text, encoding="utf-8")
                _, code = ask("scene", self._scene, "--language", "python", *source,
                              folder=folder if self._given else None)
            names: dict[str, Any] = {}
            exec(compile(code, f"<acstudy scene {self._scene}>", "exec"), names)
            self._codes[source] = names
        return self._codes[source]
