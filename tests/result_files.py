"""Synthetic result files of format acstudy-1, and the program that reports on them."""

import contextlib
import io
import math
from pathlib import Path
import sys
import tempfile
import unittest
import warnings

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "reports"))

import report


def series(**changes):
    """A confirmed first-order series of format acstudy-1 as {name: value}; arrays are data sets, others attributes."""
    N = np.array(changes.pop("N", (160, 320, 640, 1280)))
    h = 2 * math.pi / N
    error = np.array(changes.pop("error_linf", 1.3 * h))
    ones = np.ones(len(N), dtype=np.int64)
    with np.errstate(all="ignore"):
        pairwise = np.log(error[:-1] / error[1:]) / np.log(h[:-1] / h[1:])
    values = dict(
        model=1, divergence="local", kernel="inverse", path="delta = 4h", source="local", delta_text="4*h",
        step_text="h/4", integrator="forward-euler", motion="moving", theory_variable="max(h,delta)", theory_order=1.0,
        theory_statement="Theorem 2.7 (2)", observed_order=0.97, observed_low=0.95, observed_high=1.01,
        extrapolated_order=math.nan, verdict="confirmed", expected="confirmed", as_expected=1,
        reason="theory's order lies in the interval",
        N=N, h=h, delta=4 * h, dt=h / 4, steps=4 * N, variable=4 * h, error_linf=error, error_l1=error / 3,
        error_l2=error / 2, seconds=1e-5 * N, seconds_low=0.9e-5 * N, seconds_high=1.2e-5 * N, repeats=5 * ones,
        source_seconds=1e-6 * N, work_pairs=1000 * N, work_weight_builds=N, work_quadrature_points=0 * N,
        work_velocity_evaluations=N, pairwise=pairwise)
    values |= changes
    statement, _, limit = values["theory_statement"].partition(": ")
    order, variable, expected = values["theory_order"], values["theory_variable"], values["expected"]
    stability = expected in ("stable", "unstable")
    promised = "stable" if stability else "stagnates" if order == 0 else "confirmed"
    check = ", ".join(filter(None, (values["path"], values.get("stepping", ""))))
    of_check = dict(
        statement="Stiff scenes" if stability else statement, subject="a scheme", check=check,
        claim="the solution stays bounded" if stability else f"order {order:g} in {variable}" if order else
              f"the error does not vanish: {limit}",
        quantity="max-norm error at T", test="order", variable_name=variable,
        promised=expected if (promised, expected) == ("confirmed", "pre-asymptotic") else promised,
        alarm=int(values["verdict"] != promised), also_expected="", coordinates=dict(path=values["path"]))
    return of_check | values


def coordinates(check):
    """Those that the program stores with such words."""
    first, *others = check.split(", ")
    found = dict(arrangement=first, study=first)
    for word in others:
        if word.startswith("CFL "):
            found["cfl"] = float(word.removeprefix("CFL "))
        elif word.startswith("delta = ") and word.endswith("h"):
            found["delta/h"] = float(word[len("delta = "):-1] or 1)
        elif "euler" in word or "ssprk" in word or "sdirk" in word:
            found["integrator"] = word
    return found


def finding(N=(160, 320, 640, 1280), value=None, lower=-math.inf, upper=math.inf, **changes):
    """A confirmed finding of order 1 as {name: value}, or one that holds with test="bounds"."""
    N = np.array(N, dtype=np.int64)
    h = np.where(N > 0, 2 * math.pi / np.maximum(N, 1), math.nan)
    bounds = changes.get("test") == "bounds"
    good = "holds" if bounds else "confirmed"
    order = (math.nan,) * 3 if bounds else (0.98, 0.96, 1.0)
    values = dict(
        statement="Lemma 2.5", claim="truncation error O(max(h, delta))", subject="Model I, local divergence, inverse",
        check="uniform, delta = 4h", quantity="max |rate + f - du/dt|", test="order", variable_name="h",
        theory_order=1.0, observed_order=order[0], observed_low=order[1], observed_high=order[2],
        extrapolated_order=math.nan, verdict=good, promised=good, expected=good, also_expected="", as_expected=1,
        alarm=0, reason="as theory says", remark="", labels="",
        N=N, h=h, delta=4 * h, variable=h, value=np.array(h if value is None else value, dtype=float),
        lower=np.zeros(len(N)) + lower, upper=np.zeros(len(N)) + upper)
    values |= changes
    return dict(coordinates=coordinates(values["check"])) | values


def write(folder, name, *all_series, title="A study", fixed_length=False, findings=(), scene=True, **root):
    """A result file <name>.h5; `fixed_length`: text attributes as numpy bytes, as C++ may write them."""
    path = Path(folder) / f"{name}.h5"
    text = np.bytes_ if fixed_length else str
    with h5py.File(path, "w") as file:
        attributes = dict(format="acstudy-1", study=name, title=title, study_text=f'[study]\nname = "{name}"\n') | root
        for key, value in attributes.items():
            file.attrs[key] = text(value)
        file.create_group("provenance").attrs.update(version="0.1.0", created="2025-01-01T00:00:00Z")
        if scene:
            file.create_group("scene").attrs.update(name="lee-du-2019", period=2 * math.pi, T=1.0, c="cos(2*x)/3",
                                                    u="cos(x-t)", b="sin(x)")
        groups = {f"series/{i:03d}": values for i, values in enumerate(all_series)}
        groups |= {f"findings/{i:04d}": values for i, values in enumerate(findings)}
        for name_of_group, values in groups.items():
            group = file.create_group(name_of_group)
            for key, value in values.items():
                if isinstance(value, np.ndarray):
                    group[key] = value
                elif isinstance(value, dict):
                    group.create_group(key).attrs.update(value)
                else:
                    group.attrs[key] = text(value) if isinstance(value, str) else value
    return path


def of_study(html, name):
    """The part of a page that is about a study."""
    return html.partition(f'<article class="study" id="{name}"')[2].partition("</article>")[0]


class ReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_report(self, *arguments):
        """(exit code, stdout, stderr) of the program."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
            # unittest turns on the warnings that matplotlib's parser gives to its own developers.
            warnings.simplefilter("ignore")
            try:
                code = report.main([str(argument) for argument in arguments])
            except SystemExit as stop:
                code = stop.code
        return code, out.getvalue(), err.getvalue()
