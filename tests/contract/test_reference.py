"""Studies without an exact solution, as a user meets them: errors against the finest run."""

import json
import subprocess
import sys
import unittest

import h5py
import numpy as np

from tests.program import ROOT, UNSOLVED, ProgramTest, edit

FINER = edit(UNSOLVED, ('source = "local"', 'source = "local"\nreference = 256'), ("[16, 32, 64]", "[16, 32, 64, 96]"))


class ReferenceTest(ProgramTest):
    def test_errors_are_the_norms_of_differences_to_the_reference(self):
        self.run_study(FINER)
        series = self.result()["series"][0]
        self.assertEqual(([case["N"] for case in series["cases"]], series["reference"]["N"], series["cases_planned"]),
                         ([16, 32, 64, 96], 256, 5))
        self.assertNotIn("error_linf", series["reference"])
        self.assertIn("differences to the run at N = 256", series["reason"])
        with h5py.File(self.folder / "out" / "tiny.h5") as file:
            group = file["series/000"]
            scene = dict(file["scene"].attrs)
            self.assertEqual((scene["u0"], scene["f"], "u" in scene), (b"cos(x)", b"sin(x-t)", False))
            finest = group["reference/cases/256"]
            self.assertEqual(list(group["reference/N"]), [256])
            self.assertNotIn("u_exact", finest)
            for case in series["cases"]:
                stored = group["cases"][str(case["N"])]
                x, u, reference = (stored[name][()] for name in ("x", "u", "u_reference"))
                self.assertNotIn("u_exact", stored)
                width = (np.roll(x, -1) - np.roll(x, 1)) % (2 * np.pi) / 2
                error = np.abs(u - reference)
                self.assertEqual(case["error_linf"], error.max())
                self.assertAlmostEqual(case["error_l1"], np.sum(width * error) / (2 * np.pi), delta=1e-15)
                self.assertAlmostEqual(case["error_l2"], np.sqrt(np.sum(width * error**2) / (2 * np.pi)), delta=1e-15)
                if 256 % case["N"] == 0:  # at the same particles, to the last bit
                    self.assertEqual(list(reference), list(finest["u"][:: 256 // case["N"]]))
                else:
                    places = np.concatenate([finest["x"][-9:] - 2 * np.pi, finest["x"], finest["x"][:9] + 2 * np.pi])
                    values = np.concatenate([finest["u"][-9:], finest["u"], finest["u"][:9]])
                    np.testing.assert_allclose(reference, np.interp(x, places, values), rtol=0, atol=2e-2)  # its own error
            self.assertEqual(len(group["pairwise"]), 3)

    def test_the_finest_level_is_the_reference_if_none_is_named(self):
        self.run_study(edit(UNSOLVED, ('source = "local"\n', "")))
        series = self.result()["series"][0]
        self.assertEqual(([case["N"] for case in series["cases"]], series["reference"]["N"]), ([16, 32], 64))

    def test_runs_are_stored_and_errors_follow_the_reference(self):
        self.assert_counts(self.run_study(FINER), 5, 0)
        first = self.result()["series"][0]
        self.assert_counts(self.run_study(FINER), 0, 5)
        self.assertEqual(self.result()["series"][0], first)
        # Another reference: one run, and other errors of the same runs.
        self.assert_counts(self.run_study(edit(FINER, ("256", "128"))), 1, 4)
        second = self.result()["series"][0]
        self.assertTrue(all(a["error_linf"] > b["error_linf"] for a, b in zip(first["cases"], second["cases"])))
        # The reference becomes a level.
        self.assert_counts(self.run_study(edit(FINER, ("64, 96]", "64, 96, 128]"))), 1, 5)
        self.assertGreater(self.result()["series"][0]["cases"][-1]["error_linf"], 0)
        # Another source, other initial values: nothing is taken from the store.
        self.assert_counts(self.run_study(edit(FINER, ('"sin(x-t)"', '"sin(x)"'))), 5, 0)
        self.assert_counts(self.run_study(edit(FINER, ('"cos(x)"', '"sin(x)"'))), 5, 0)

    def test_the_gate_judges_the_file_as_the_run_did(self):
        good = edit(FINER, ("[16, 32, 64, 96]", "[80, 160, 320, 640]"), ("256", "1280"),
                    ('"sin(x-t)"', '"sin(x-t) - 2*sin(2*x)/3*cos(x-t) - cos(2*x)/3*sin(x-t)"'), ('"4*h"', '"h^2"'))
        self.run_study(good, expect=0)
        file = self.folder / "out" / "tiny.json"
        self.assertEqual(self.acstudy("check", file).returncode, 0)
        # Its limit is not known, so it is no evidence for a theorem.
        claims = subprocess.run([sys.executable, ROOT / "scripts" / "claims.py", self.folder / "out"], text=True,
                                capture_output=True, check=True).stdout
        self.assertEqual(len(claims.splitlines()), 2)
        data = self.result()
        self.assertAlmostEqual(data["series"][0]["observed"]["order"], 1.0, delta=0.03)
        for change, reason in ((lambda series: series.pop("reference"), "4 of 5 cases; the run was interrupted"),
                               (lambda series: series["cases"].pop(), "4 of 5 cases; the run was interrupted"),
                               (lambda series: series["reference"].update(failure="on purpose"), "on purpose"),
                               (lambda series: [case.update(error_linf=0.1) for case in series["cases"]],
                                "differences to the run at N = 1280")):
            changed = json.loads(json.dumps(data))
            change(changed["series"][0])
            file.write_text(json.dumps(changed), encoding="utf-8")
            done = self.acstudy("check", "-v", file)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn(reason, done.stdout)

    def test_explain_says_what_errors_are_against(self):
        self.write("tiny.toml", FINER)
        said = self.acstudy("explain", "tiny.toml").stdout
        for line in ("  u = cos(x) at t = 0, not known later\n", "  f = sin(x-t)\n",
                     "  reference: the run at N = 256; to it the finest level has 62 % of its error, which the judge "
                     "makes up for\n", "0.333  reference\n", "f is given"):
            self.assertIn(line, said)
        self.write("few.toml", UNSOLVED)
        self.assertIn("fewer than four levels beside the reference", self.acstudy("explain", "few.toml").stdout)

    def test_a_reference_that_blows_up_leaves_no_errors(self):
        self.run_study(edit(FINER, ("256", "1024"), ('step = "h/4"', 'step = "h/4*max(1, 5*(N - 1023))"'),
                            ('"4*h"', '"h^2"')), expect=3)
        series = self.result()["series"][0]
        self.assertEqual(({case["error_linf"] for case in series["cases"]}, series["verdict"]), ({None}, "unstable"))
        self.assertIn("blow_up", series["reference"])

    def test_what_needs_errors_refuses_a_study_without_a_solution(self):
        self.write("tiny.toml", UNSOLVED)
        self.assert_bad_input(self.acstudy("bench", "tiny.toml"),
                              "tiny.toml: bench sets run times against errors, and this scene has a reference in place "
                              "of u")
        text = '[study]\nname = "budget"\nkind = "pollution"\n\n[pollution]\nstudies = ["tiny.toml"]\n'
        self.write("budget.toml", text)
        self.assert_bad_input(self.acstudy("run", "budget.toml"),
                              'budget.toml:6:12: studies contains "tiny.toml", whose scene has a reference in place of u; '
                              "an error has parts only if it is known")


if __name__ == "__main__":
    unittest.main()
