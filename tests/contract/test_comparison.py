"""The comparison with other programs: they do the same cases, and one with a mistake is refused."""

import importlib.util
import json
from pathlib import Path
import re
import subprocess
import sys
import tempfile
import unittest

from tests.program import ACSTUDY, ROOT

FOLDER = ROOT / "scripts" / "compare"
sys.path.insert(0, str(FOLDER))
sys.path.insert(0, str(ROOT / "reports"))

from pages import comparison
import programs
from reading import results
import selection
import summary


@unittest.skipUnless(importlib.util.find_spec("numpy"), "needs NumPy")
class Comparison(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def compare(self, *arguments, script=FOLDER):
        return subprocess.run([sys.executable, script / "compare.py", "--quick", "--rounds", "1", "--out", self.folder,
                               "--acstudy", ACSTUDY, *arguments], text=True, capture_output=True, check=False,
                              timeout=100)

    def stored(self):
        return json.loads((self.folder / "compare.json").read_text(encoding="utf-8"))

    def copy_with(self, file, old, new):
        """A copy of the programs in the tree that they expect, `file` changed."""
        copy = self.folder / "scripts" / "compare"
        copy.mkdir(parents=True)
        (self.folder / "studies").symlink_to(ROOT / "studies")
        for path in FOLDER.iterdir():
            if path.is_file():
                text = path.read_text(encoding="utf-8")
                if path.name == file:
                    self.assertEqual(text.count(old), 1)
                    text = text.replace(old, new)
                (copy / path.name).write_text(text, encoding="utf-8")
        return copy

    def test_numpy_has_the_same_errors_in_every_scheme_kernel_and_path(self):
        done = self.compare("--programs", "numpy-views", "numpy-pairs", "acstudy-readable")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stderr.startswith("compare.py: some 45 s for three rounds"), done.stderr)
        found = self.stored()
        self.assertEqual((len(found["cases"]), found["wrong"]), (24, []))
        for name in ("numpy-views", "numpy-pairs"):
            moving = [i for i, case in enumerate(found["cases"]) if case["scene"] != "standing"]
            self.assertEqual([i for i in moving if str(i) not in found["rounds"][0][name]["cases"]], [])
        self.assertIn("| NumPy, tuned |", done.stdout)
        again = subprocess.run([sys.executable, FOLDER / "compare.py", "--table", "--out", self.folder], text=True,
                               capture_output=True, check=False)
        self.assertEqual((again.returncode, again.stdout), (0, done.stdout))
        html = comparison.section(comparison.read(self._as_results()))
        self.assertIn("All programs have the same errors", html)
        self.assertIn("NumPy, as printed", html)

    def _as_results(self):
        (self.folder / "compare").symlink_to(self.folder)
        return self.folder

    def test_a_program_with_a_mistake_is_refused(self):
        copy = self.copy_with("numpy_pairs.py", "midpoint = x[:, None] - s * d / 2",
                              "midpoint = x[:, None] - s * d / 2.00001")
        done = self.compare("--studies", "fig3", "--programs", "numpy-pairs", script=copy)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stdout, "")
        self.assertIn("numpy-pairs: Model II, cubic-spline, local divergence, delta = 0.2, N = 160: error", done.stderr)
        self.assertEqual((len(self.stored()["wrong"]), self.stored()["tables"]), (2, []))
        self.assertIn('class="outcome bad"', comparison.section(comparison.read(self._as_results())))

    def test_an_error_that_is_no_number_or_off_by_more_than_round_off_disagrees(self):
        case = selection.Case("standing", 1, "local", "inverse", "p", "local", 8, 0.2, 4, 0.0, 0.5)
        program = programs.Program("one", "One", None)
        for error, lines in ((0.5, 0), (0.5 * (1 + 9e-10), 0), (0.5 * (1 + 2e-9), 1), (float("nan"), 1)):
            with self.subTest(error):
                outcome = programs.Outcome(1.0, [(error, 1.0)])
                self.assertEqual(len(summary.disagreements([case], program, outcome)), lines)

    def test_all_levels_are_the_88_distinct_cases_of_the_figures(self):
        found = set()
        for name in ("fig1", "fig2", "fig3", "fig4", "fig5"):
            text = selection.STUDIES[name].read_text(encoding="utf-8")
            self.assertEqual(selection.cut_study(text, selection.every), text)
            step = re.search('step = "(.*)"', text)[1]
            schemes = re.findall('model = (.)\ndivergence = "(.*)"\nkernel = "(.*)"', text)
            for path in selection.PATH.split(text)[1:]:
                delta = re.search("^delta = (.*)", path, re.M)[1]
                for N in selection.LEVELS.search(path)[1].split(", "):
                    found |= {(*scheme, step, delta, N) for scheme in schemes}
        self.assertEqual(len(found), 88)

    def test_what_is_not_there_is_said(self):
        self.assertEqual(self.compare("--programs", "fortran").returncode, 2)
        self.assertEqual(self.compare("--acstudy", self.folder / "none").returncode, 4)
        self.assertEqual(programs.python_with("no_such_module"), (None, ""))
        missing = programs.python_program("one", "One", "one.py", ("no_such_module",), "python3-one").missing
        self.assertIn("python3-one", missing)
        self.assertIsNone(comparison.read(self.folder))
        self.assertIn("make compare", comparison.section(None))
        (self.folder / "compare").mkdir()
        (self.folder / comparison.FILE).write_text("{}", encoding="utf-8")
        with self.assertRaises(results.ResultError):
            comparison.read(self.folder)


if __name__ == "__main__":
    unittest.main()
