"""Every example of another program, copied from an installed acstudy and run by it."""

import importlib.util
import os
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
import unittest

from tests.program import ROOT, ProgramTest, install

SHOWN = {"upwind": [("upwind", "confirmed"), ("upwind with a mistake", "stagnates")],
         "upwind-c": [("upwind in C", "confirmed")],
         "upwind-fortran": [("upwind in Fortran", "confirmed")],
         "finite-volume": [("linear reconstruction, Heun's steps", "confirmed")],
         "pysph": [("PySPH, cubic spline", "confirmed"), ("PySPH, cubic spline", "stagnates")]}


def compiler(*names):
    """A compiler that is there, or the test is skipped."""
    found = next(filter(None, map(shutil.which, names)), None)
    if found is None:
        raise unittest.SkipTest(f"no {names[-1]} here")
    return found


class Examples(ProgramTest):
    examples = ROOT / "examples"

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        prefix = Path(folder.name)
        if install(prefix):
            cls.examples, cls.program = prefix / "share" / "acstudy" / "examples", prefix / "bin" / "acstudy"

    def setUp(self):
        super().setUp()
        python = self.folder / "bin" / "python3"
        python.parent.mkdir()
        python.write_text(f"#!/bin/sh\nexec '{sys.executable}' \"$@\"\n", encoding="utf-8")
        python.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{python.parent}:{os.environ['PATH']}"}

    def run_example(self, name, *arguments, expect=0, change=None):
        """Runs a copy of the example; returns the label and verdict of each series."""
        copy = self.folder / name
        shutil.copytree(self.examples / name, copy, ignore=shutil.ignore_patterns("upwind"), dirs_exist_ok=True)
        if change is not None:
            change(copy)
        done = self.acstudy("run", f"{name}/{name}.toml", "--out", "out", *arguments, env=self.environment)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return [(series["label"], series["verdict"].replace("pre-asymptotic", "confirmed"))
                for series in self.result(name)["series"]]

    def build(self, *command):
        def build(folder):
            done = subprocess.run(command, cwd=folder, text=True, capture_output=True, check=False, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        return build

    def test_all_of_them_are_known_and_have_a_page(self):
        with_command = {study.parent.name for study in self.examples.glob("*/*.toml") if "\ncommand = " in study.read_text()}
        self.assertEqual(with_command, set(SHOWN))
        for name in SHOWN:
            self.assertIn(f"examples/{name}/{name}.toml --out out", (self.examples / name / "README.md").read_text())

    def test_upwind_and_its_mistake(self):
        self.assertEqual(self.run_example("upwind"), SHOWN["upwind"])

    def test_the_mistake_is_noticed_where_it_is_not_expected(self):
        def put(folder):
            study = folder / "upwind.toml"
            study.write_text("\n".join(line for line in study.read_text().splitlines() if "expect" not in line))
        self.assertEqual(self.run_example("upwind", expect=1, change=put), SHOWN["upwind"])

    def test_upwind_c(self):
        build = self.build(compiler("cc", "gcc", "a C compiler"), "-O2", "-Wall", "upwind.c", "-o", "upwind", "-lm")
        self.assertEqual(self.run_example("upwind-c", change=build), SHOWN["upwind-c"])

    def test_upwind_fortran(self):
        build = self.build(compiler("gfortran"), "-O2", "-Wall", "upwind.f90", "-o", "upwind")
        self.assertEqual(self.run_example("upwind-fortran", change=build), SHOWN["upwind-fortran"])

    def test_finite_volume(self):
        self.assertEqual(self.run_example("finite-volume"), SHOWN["finite-volume"])
        self.assertAlmostEqual(self.result("finite-volume")["series"][0]["observed"]["order"], 2, delta=0.05)

    @unittest.skipIf(importlib.util.find_spec("pysph") is None, "no PySPH here")
    def test_pysph(self):
        self.assertEqual(self.run_example("pysph"), SHOWN["pysph"])

    def test_a_report_has_them(self):
        self.run_example("upwind")
        done = subprocess.run([sys.executable, ROOT / "reports" / "report.py", self.folder / "out"], text=True,
                              capture_output=True, check=False, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = Path(self.folder, "out", "index.html").read_text(encoding="utf-8")
        for label, _ in SHOWN["upwind"]:
            self.assertIn(label, page)
        self.assertNotIn("Model 0", page)


if __name__ == "__main__":
    unittest.main()
