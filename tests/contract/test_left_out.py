"""What a study does without: no work is done for it, and explain says so."""

import os
import re
import unittest

from tests.program import CASES_OF_WIDE, MODEL_II, ROOT, SCENE, STUDY, WIDE, ProgramTest, edit


class LeftOut(ProgramTest):
    """What a study does not need is not computed, and explain says so."""

    STANDING = edit(STUDY, (SCENE, '"standing-variable-velocity"'))

    def cases(self, text):
        self.run_study(text, "--fresh")
        return [case for series in self.result()["series"] for case in series["cases"]]

    def explain(self, text):
        self.write("tiny.toml", text)
        before = sorted(os.listdir(self.folder))
        done = self.acstudy("explain", "tiny.toml")
        self.assertEqual((done.returncode, done.stderr, sorted(os.listdir(self.folder))), (0, "", before))
        return done.stdout

    def test_standing_particles_have_one_set_of_weights_and_no_flow(self):
        for text in (self.STANDING, edit(self.STANDING, MODEL_II, ('"h/4"', '"h/8"'), ("forward-euler", "ssprk3")),
                     edit(self.STANDING, ('divergence = "local"\n', ""))):
            for case in self.cases(text):
                self.assertGreater(case["steps"], 1)
                self.assertEqual((case["work"]["weight_builds"], case["work"]["flow_evaluations"]), (1, 0))
        said = self.explain(self.STANDING)
        self.assertIn("particle motion", said)
        self.assertIn("weight_builds = 1", said)

    def test_moving_particles_have_both_anew_at_every_stage(self):
        # The second stage of SSPRK2 stands where the next step starts, and the first place is the start.
        for integrator, places in (("forward-euler", 1), ("ssprk2", 1), ("ssprk3", 2)):
            for case in self.cases(edit(STUDY, ("forward-euler", integrator))):
                self.assertGreaterEqual(case["work"]["weight_builds"], places * case["steps"])
                self.assertGreaterEqual(case["work"]["flow_evaluations"], places * case["N"] * (case["steps"] - 1))
        self.assertNotIn("particle motion", self.explain(STUDY))

    def test_a_local_source_needs_no_quadrature(self):
        nonlocal_source = edit(STUDY, ('source = "local"', 'source = "nonlocal"'))
        for case in self.cases(STUDY):
            self.assertEqual(case["work"]["quadrature_points"], 0)
        for case in self.cases(nonlocal_source):
            self.assertGreater(case["work"]["quadrature_points"], case["N"] * case["steps"])
        self.assertIn("quadrature_points = 0", self.explain(STUDY))
        self.assertNotIn("quadrature_points = 0", self.explain(nonlocal_source))

    def test_a_horizon_below_the_spacing_leaves_the_nearest_neighbors(self):
        # Below every gap: particles approach each other by a factor e at most.
        below = ("4*h", "h^2/8")
        for integrator, stages in (("forward-euler", 1), ("ssprk2", 2), ("ssprk3", 3)):
            one = edit(STUDY, below, ("forward-euler", integrator))
            two = edit(one, MODEL_II)
            for text, sides in ((one, 1), (two, 2)):
                for case in self.cases(text):
                    self.assertEqual(case["work"]["pairs"], sides * case["N"] * stages * case["steps"])
        self.assertIn("1 in Model I, 2 in Model II", self.explain(edit(STUDY, below)))
        self.assertNotIn("1 in Model I, 2 in Model II", self.explain(STUDY))

    def test_explain_names_every_case_and_nothing_that_is_not_left_out(self):
        full = edit(STUDY, MODEL_II, ("forward-euler", "ssprk2"), ('source = "local"', 'source = "nonlocal"'))
        said = self.explain(full)
        self.assertTrue(said.endswith("left out, because nothing here needs it:\n  - nothing\n"), said)
        for words in ("tiny - A tiny study", "lee-du-2019", "cos(2*x)/3", "sin(x)", "ssprk2", "step h/4", "delta = 4h",
                      "source nonlocal", "mu = 1.33333", "1 series, 3 cases"):
            self.assertIn(words, said)
        self.assertEqual([int(row.split()[0]) for row in said.splitlines() if re.match(r" +\d+ ", row)], [16, 32, 64])
        self.assertIn("viscosity and midpoint velocities in Model I", self.explain(STUDY))
        self.assertNotIn("viscosity", said)
        self.assertIn("stage storage", self.explain(STUDY))

    def test_explain_counts_the_series_and_cases_of_every_study(self):
        self.assertIn(f"9 series, {CASES_OF_WIDE} cases", self.explain(WIDE))
        for study in sorted((ROOT / "studies").glob("*.toml")):
            done = self.acstudy("explain", study)
            self.assertEqual((done.returncode, done.stderr), (0, ""), study)

    def test_explain_says_in_which_form_each_series_runs(self):
        def form(*changes):
            return re.findall(r"^  form: (.*)$", self.explain(edit(STUDY, *changes)), re.MULTILINE)

        self.assertEqual(form(), ["vector"])
        self.assertEqual(form(("forward-euler", "sdirk2")), ["vector with implicit steps"])
        self.assertEqual(form(('"h/4"', '"cfl"\nbound = "rows"')), ["vector"])
        self.assertEqual(form(('"4*h"', '"1"'), ("[16, 32, 64]", "[64, 512, 2048]")),
                         ["vector up to N = 512, vector with far sums up to N = 2048"])

    def test_explain_warns_of_steps_and_viscosity_beyond_the_lemmas(self):
        self.assertIn("beyond the bound 1 of the stability lemma", self.explain(edit(STUDY, ('"h/4"', '"h"'))))
        self.assertNotIn("beyond", self.explain(STUDY))
        self.assertIn("Lemma 3.3 does not promise stability", self.explain(
            edit(STUDY, MODEL_II, ('"cubic-spline"', '"cubic-spline"\nmu = 1'))))


if __name__ == "__main__":
    unittest.main()
