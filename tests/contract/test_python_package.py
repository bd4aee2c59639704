"""import acstudy: what it gives is what the program prints; it installs without network; its example draws."""

import csv
import importlib.util
import io
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock
import warnings

import numpy as np

from tests.program import ACSTUDY, ROOT, STUDY, ProgramTest, edit

sys.path.insert(0, str(ROOT / "python"))
os.environ["ACSTUDY"] = str(ACSTUDY)

import acstudy  # noqa: E402
import acstudy.studies  # noqa: E402

HALVED = [0.1, 0.05, 0.025, 0.0125, 0.00625]
SECOND = [0.31, 0.078, 0.0196, 0.0049, 0.00123]
POINTS = np.linspace(-1.0, 7.0, 41)
TIME = 0.4
FIELDS = {"period": "2*pi", "T": 0.5, "c": "cos(2*x)/3", "b": "sin(x)", "u": "cos(x - t)"}
EXAMPLE = ROOT / "examples" / "python"


class JudgeTest(ProgramTest):
    def test_verdicts_are_those_of_the_program(self):
        for h, errors, order, code in ((HALVED, SECOND, 2, 0), (HALVED, SECOND, 1, 1), (HALVED, SECOND, None, 0),
                                       (HALVED[:2], SECOND[:2], 2, 1), (HALVED, [1, 0.5, np.nan, 0.1, 0.05], 1, 1),
                                       (np.array(HALVED), 3.0 * np.array(HALVED)**1.5, 1.5, 0)):
            with self.subTest(errors=errors, order=order):
                table = "h,error\n" + "".join(f"{v},{e}\n" for v, e in zip(h, errors))
                expected = self.fitted(table, *([] if order is None else ["--order", order]), code=code)
                verdict = acstudy.judge(h, errors, order)
                self.assertEqual(verdict.estimates, expected)
                self.assertEqual((verdict.ok, bool(verdict), verdict.verdict, verdict.reason),
                                 (code == 0, code == 0, expected["verdict"], expected["reason"]))
                np.testing.assert_equal([verdict.order, verdict.low, verdict.high, *verdict.pairwise], np.array(
                    [expected["order"], expected["low"], expected["high"], *expected["pairwise"]], float))

    def test_options_reach_the_program(self):
        table = "h,error\n" + "".join(f"{v},{e}\n" for v, e in zip(HALVED, SECOND))
        expected = self.fitted(table, "--order", 2, "--floor", 0.01, "--scale", 3, code=1)
        self.assertEqual(acstudy.judge(HALVED, SECOND, 2, floor=0.01, scale=3).estimates, expected)
        values = acstudy.judge(HALVED, [1.0 + e for e in SECOND], 2, values=True)
        self.assertAlmostEqual(values.estimates["extrapolated"], 1.0, delta=1e-3)

    def test_an_order_that_is_there_passes(self):
        self.assertEqual(acstudy.assert_order(HALVED, SECOND, 2).verdict, "confirmed")

    def test_an_order_that_is_not_there_fails_with_the_reason(self):
        for errors, order in ((SECOND, 1), (SECOND, 3), ([0.1 + e for e in SECOND], 2), (HALVED[:2] + [np.inf] * 3, 1)):
            verdict = acstudy.judge(HALVED, errors, order)
            with self.assertRaises(AssertionError) as raised:
                acstudy.assert_order(HALVED, errors, order)
            self.assertEqual(str(raised.exception), f"order {order} is not seen: {verdict.verdict}: {verdict.reason}")

    def test_mistakes_are_said_as_the_program_says_them(self):
        with self.assertRaisesRegex(ValueError, "2 spacings and 1 errors"):
            acstudy.judge([0.1, 0.05], [1.0], 1)
        done = self.acstudy("fit", "-", input="h,error\n-0.1,1.0\n0.1,2.0\n")
        with self.assertRaises(acstudy.InputError) as raised:
            acstudy.judge([-0.1, 0.1], [1.0, 2.0])
        self.assertEqual((f"acstudy: {raised.exception}\n", raised.exception.code), (done.stderr, 2))

    def test_a_program_that_is_not_there_is_named(self):
        with mock.patch.dict(os.environ, {"ACSTUDY": "/no/acstudy"}), \
                self.assertRaisesRegex(FileNotFoundError, "ACSTUDY = /no/acstudy"):
            acstudy.judge(HALVED, SECOND)
        with mock.patch.dict(os.environ, {"PATH": str(self.folder)}):
            del os.environ["ACSTUDY"]
            with self.assertRaisesRegex(FileNotFoundError, "on the PATH"):
                acstudy.program()
            (self.folder / "acstudy").symlink_to(ACSTUDY)
            self.assertTrue(acstudy.judge(HALVED, SECOND, 2))


class SceneTest(ProgramTest):
    def expected(self, scene, *options):
        """Columns that the program prints of a scene."""
        self.write("x.csv", "x\n" + "".join(f"{x!r}\n" for x in POINTS.tolist()))
        done = self.acstudy("scene", scene, *options, "--at", "x.csv", "--time", TIME)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}

    def assert_same(self, found, expected):
        self.assertEqual(found.shape, expected.shape)
        self.assertLessEqual(np.abs(found - expected).max(), 1e-13 * np.abs(expected).max())

    def test_values_are_those_of_the_program(self):
        study = self.write("fields.toml", "[scene]\n" + "".join(f"{k} = {v!r}\n" for k, v in FIELDS.items()))
        standing = self.write("standing.toml", '[scene]\nperiod = 1\nT = 1\nc = -1\nu = "sin(2*pi*(x+t))"\n')
        for scene, name in ((acstudy.Scene("lee-du-2019"), "lee-du-2019"), (acstudy.Scene(**FIELDS), study),
                            (acstudy.Scene(study), study),
                            (acstudy.Scene(period=1, T=1, c=-1, u="sin(2*pi*(x+t))"), standing)):
            with self.subTest(scene=name):
                expected = self.expected(name)
                self.assert_same(scene.c(POINTS), expected["c"])
                self.assert_same(scene.b(POINTS), expected.get("b", np.zeros(len(POINTS))))
                self.assert_same(scene.u(POINTS, TIME), expected["u"])
                self.assertLessEqual(np.abs(scene.source(POINTS, TIME) - expected["f"]).max(), 1e-13)
        self.assertEqual(acstudy.Scene(**FIELDS).T, 0.5)
        self.assertAlmostEqual(acstudy.Scene(**FIELDS).period, 2 * np.pi, places=15)

    def test_sources_of_models_are_those_of_the_program(self):
        scene = acstudy.Scene("lee-du-2019")
        for model, divergence, kernel, text in (
                (1, "local", "inverse", "inverse"), (1, "nonlocal", {"name": "power", "alpha": 0.5},
                                                     '{ name = "power", alpha = 0.5 }'),
                (2, "local", "cubic-spline", "cubic-spline")):
            with self.subTest(model=model, kernel=kernel):
                expected = self.expected("lee-du-2019", *"--source nonlocal --delta 0.3".split(), "--model", model,
                                         "--divergence", divergence, "--kernel", text)["f"]
                found = scene.source(POINTS, TIME, model, divergence=divergence, kernel=kernel, delta=0.3)
                self.assert_same(found, expected)
                other = scene.source(POINTS, TIME, model, divergence=divergence, kernel=kernel, delta=0.31)
                self.assertGreater(np.abs(other - expected).max(), 1e-5)

    def test_numbers_lists_and_shapes(self):
        scene = acstudy.Scene(**FIELDS)
        self.assertEqual(float(scene.u(1, 0.5)), float(scene.u([1.0], 0.5)[0]))
        self.assertEqual(scene.source(np.ones((2, 3)), 0.1).shape, (2, 3))
        np.testing.assert_array_equal(scene.u0(POINTS), scene.u(POINTS, 0.0))

    def test_without_a_solution_there_is_its_start_and_its_source(self):
        scene = acstudy.Scene(period="2*pi", T=1, c="1", reference="finest", u0="exp(cos(x))", f="sin(x - t)")
        self.assert_same(scene.u0(POINTS), np.exp(np.cos(POINTS)))
        self.assert_same(scene.source(POINTS, TIME), np.sin(POINTS - TIME))
        with self.assertRaisesRegex(ValueError, "no exact solution is known"):
            scene.u(POINTS, TIME)

    def test_mistakes_are_said(self):
        for make, message in ((lambda: acstudy.Scene("lee-du"), "unknown scene .lee-du.;"),
                              (lambda: acstudy.Scene(period=1, T=1, c="1 +", u="x"), r"scene.toml:4:"),
                              (lambda: acstudy.Scene("lee-du-2019").source(0.0, 0.0, 1), "needs a horizon")):
            with self.assertRaisesRegex(acstudy.InputError, message):
                make()
        for arguments, fields in ((["lee-du-2019"], FIELDS), ([], {})):
            with self.assertRaisesRegex(TypeError, "write one of them"):
                acstudy.Scene(*arguments, **fields)


class ResultsTest(ProgramTest):
    def run_tiny(self):
        self.write("tiny.toml", STUDY)
        return acstudy.run(self.folder / "tiny.toml", out=self.folder / "out", jobs=1)

    def assert_holds_what_is_stored(self, table):
        series = self.result()["series"][0]
        self.assertEqual(len(table), 3)
        for name in ("N", "h", "delta", "dt", "steps", "error_linf", "error_l1", "error_l2", "seconds"):
            self.assertEqual(list(table[name]), [case[name] for case in series["cases"]], name)
        for name in ("order", "low", "high"):
            self.assertEqual(list(table[name]), 3 * [series["observed"][name]])
        for name, value in (("study", "tiny"), ("kind", "convergence"), ("scheme", series["subject"]),
                            ("path", "delta = 4h"), ("kernel", "inverse"), ("verdict", series["verdict"]),
                            ("as_expected", series["as_expected"]), ("theory_order", 1.0)):
            self.assertEqual(list(table[name]), 3 * [value])
        self.assertEqual(list(table[table["N"] == 32]["h"]), [series["cases"][1]["h"]])

    @unittest.skipUnless(acstudy.studies.pandas, "there is no pandas")
    def test_with_pandas(self):
        table = self.run_tiny()
        self.assertIsInstance(table, acstudy.studies.pandas.DataFrame)
        self.assert_holds_what_is_stored(table)
        with mock.patch.object(acstudy.studies, "pandas", None):
            array = acstudy.results(self.folder / "out")
        self.assertEqual(list(table.columns), list(array.dtype.names))

    def test_without_pandas(self):
        with mock.patch.object(acstudy.studies, "pandas", None):
            table = self.run_tiny()
            self.assertIsInstance(table, np.ndarray)
            self.assert_holds_what_is_stored(table)

    def test_other_kinds_of_study_have_their_values(self):
        self.write("bounds.toml", edit(STUDY[:STUDY.index("[time]")] + "[sweep]\nN = [16]\nratios = [2]\n",
                                       ("[study]\n", '[study]\nkind = "identities"\n'), ('"tiny"', '"bounds"')))
        self.run_tiny()
        table = acstudy.run(self.folder / "bounds.toml", out=self.folder / "out")
        points = [point["value"] for finding in self.result("bounds")["findings"] for point in finding["points"]]
        self.assertEqual(list(table["value"]), points)
        self.assertTrue(np.isnan(table["error_linf"]).all())
        for name, text in (("bench", '{"format": "acstudy-bench-1", "series": []}'), ("list", "[1]")):
            self.write(f"out/{name}.json", text)  # not results of a study
        self.assertEqual(len(acstudy.results(self.folder / "out")), len(points) + 3)

    def test_a_verdict_that_departs_is_in_the_table(self):
        self.write("tiny.toml", edit(STUDY, ('source = "local"\n', 'source = "local"\nexpect = "above"\n')))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = acstudy.run(self.folder / "tiny.toml", out=self.folder / "out")
        self.assertEqual(set(table["as_expected"]), {False})

    def test_mistakes_are_said(self):
        self.write("tiny.toml", edit(STUDY, ("N = [16, 32, 64]", "N = [2]")))
        with self.assertRaisesRegex(acstudy.InputError, "tiny.toml:20:6: N = 2"):
            acstudy.run(self.folder / "tiny.toml", out=self.folder / "out")
        with self.assertRaisesRegex(FileNotFoundError, "no results"):
            acstudy.results(self.folder)


LACKING = [name for name in ("pip", "setuptools", "wheel") if importlib.util.find_spec(name) is None]


@unittest.skipIf(LACKING, f"this Python has no {', '.join(LACKING)}")
class InstalledTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        source, cls.place = Path(folder.name, "source"), Path(folder.name, "place")
        source.mkdir()
        for name in ("pyproject.toml", "setup.py", "CMakeLists.txt", "LICENSE"):
            shutil.copy(ROOT / name, source)
        shutil.copytree(ROOT / "python", source / "python", ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
        done = subprocess.run([sys.executable, *"-m pip install --no-index --no-build-isolation --no-deps".split(),
                               *"--no-cache-dir --disable-pip-version-check --target".split(), cls.place, source],
                              env={**os.environ, "ACSTUDY_PROGRAM": str(ACSTUDY)}, capture_output=True, text=True,
                              check=False, timeout=120)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)

    def python(self, *arguments, PATH="/nowhere"):
        """Runs Python with nothing but the installed package, in the temporary folder."""
        environment = {name: value for name, value in os.environ.items() if name != "ACSTUDY"}
        return subprocess.run([sys.executable, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              env={**environment, "PYTHONPATH": str(self.place), "PATH": PATH}, check=False,
                              timeout=120)

    def test_the_package_brings_the_program(self):
        done = self.python("-c", "from acstudy import *; print(program()); print(judge([4, 2, 1], [16, 4, 1], 2))")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        program, verdict = done.stdout.splitlines()
        self.assertEqual(Path(program), self.place / "acstudy" / "bin" / "acstudy")
        self.assertEqual(verdict, str(acstudy.judge([4, 2, 1], [16, 4, 1], 2)))
        self.assertTrue((self.place / "acstudy" / "py.typed").exists())

    def test_the_wheel_is_for_this_kind_of_machine_and_any_python(self):
        tag = re.search(r"^Tag: (.*)$", next(self.place.glob("*.dist-info/WHEEL")).read_text(encoding="utf-8"), re.M)[1]
        self.assertRegex(tag, r"^py3-none-(?!any)\w+$")

    def test_the_example_draws_its_figure(self):
        done = self.python(EXAMPLE / "paper_figure.py")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("confirmed: ", done.stdout)
        pdf = (self.folder / "convergence.pdf").read_bytes()
        box = re.search(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)\s*\]", pdf)
        self.assertAlmostEqual(float(box[1]), 3.4 * 72, places=3)
        fonts = re.findall(rb"/Type /FontDescriptor\b", pdf)
        self.assertGreater(len(fonts), 0)
        self.assertEqual(len(fonts), len(re.findall(rb"/FontFile2 ", pdf)))

    @unittest.skipUnless(shutil.which("latex"), "there is no LaTeX")
    def test_the_example_sets_its_figure_in_latex(self):
        done = self.python(EXAMPLE / "paper_figure.py", "--latex", PATH=os.environ["PATH"])
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
