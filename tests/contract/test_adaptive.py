"""Adaptive steps: what a study may ask for, and what its results say of them."""

import json
import unittest

import h5py
import numpy as np

from tests.program import INLINE, MODEL_II, STUDY, ProgramTest, edit

EQUAL = ('integrator = "forward-euler"\nstep = "h/4"', )


def adaptive(integrator, tolerance, *more, study=STUDY):
    """A study with adaptive steps in place of equal ones."""
    lines = [f'integrator = "{integrator}"', 'step = "adaptive"', f"tolerance = {tolerance}", *more]
    return edit(study, (*EQUAL, "\n".join(lines)))


class Adaptive(ProgramTest):
    def cases(self, text, *arguments, out="out"):
        self.run_study(text, *arguments, out=out)
        return [series["cases"] for series in self.result(out=out)["series"]]

    def test_the_error_of_time_falls_with_the_tolerance(self):
        """At one level errors settle at that of space, which a far smaller tolerance shows."""
        for integrator in ("ssprk2", "ssprk3", "sdirk2", "sdirk3"):
            with self.subTest(integrator):
                series = self.cases(adaptive(integrator, "[1e-2, 1e-3, 1e-4, 1e-7]"), out=integrator)
                self.assertEqual(len(series), 4)
                for level in range(3):
                    steps = [cases[level]["steps"] for cases in series]
                    self.assertEqual(steps, sorted(steps))
                    self.assertGreater(steps[3], 3 * steps[2] if "sdirk" in integrator else steps[2])
                    self.assertEqual([cases[level]["tolerance"] for cases in series], [1e-2, 1e-3, 1e-4, 1e-7])
                    errors = [cases[level]["error_linf"] for cases in series]
                    for error, tolerance in zip(errors[:3], (1e-2, 1e-3, 1e-4)):
                        self.assertLess(abs(error - errors[3]), 50 * tolerance)

    def test_both_forms_take_the_same_steps(self):
        for integrator in ("ssprk2", "ssprk3", "sdirk3"):
            for model in ((), (MODEL_II,)):
                with self.subTest(integrator=integrator, model=model):
                    text = adaptive(integrator, "1e-5", 'first = "1"', study=edit(STUDY, *model))
                    both = [self.cases(text, "--form", form, out=form)[0] for form in ("readable", "vector")]
                    for one, other in zip(*both):
                        self.assertGreater(one["rejected"], 0)
                        for name in ("N", "steps", "rejected", "tolerance"):
                            self.assertEqual(one[name], other[name], name)
                        for name in ("dt", "dt_smallest", "error_linf"):
                            self.assertLess(abs(one[name] / other[name] - 1), 1e-6, name)

    def test_numbers_do_not_depend_on_jobs(self):
        text = adaptive("ssprk3", "1e-6")
        one, two = (self.cases(text, "--jobs", jobs, out=jobs)[0] for jobs in ("1", "2"))
        for a, b in zip(one, two):
            self.assertEqual([a[name] for name in ("steps", "error_linf", "error_l2", "dt")],
                             [b[name] for name in ("steps", "error_linf", "error_l2", "dt")])

    def test_a_tolerance_in_h(self):
        for case in self.cases(adaptive("ssprk2", '"1e-2*h^2"'))[0]:
            self.assertAlmostEqual(case["tolerance"], 1e-2 * case["h"] ** 2, delta=1e-18)

    def test_results_and_texts_say_what_steps_were_taken(self):
        text = adaptive("sdirk3", "[1e-3, 1e-5]", "first = 1")
        done = self.run_study(text, "-v")
        result = self.result()
        for series in result["series"]:
            for case in series["cases"]:
                self.assertIn(f"{case['steps']} + {case.get('rejected', 0)} at N = {case['N']}", done.stdout)
        self.assertEqual([series["step"] for series in result["series"]], ["adaptive to 0.001", "adaptive to 1e-05"])
        self.assertEqual([series["stepping"] for series in result["series"]],
                         ["sdirk3, adaptive to 0.001", "sdirk3, adaptive to 1e-05"])
        self.assertNotIn("beyond the bound", done.stderr)
        with h5py.File(self.folder / "out" / "tiny.h5") as file:
            for name, series in zip(sorted(file["series"]), result["series"]):
                group = file["series"][name]
                for column in ("tolerance", "steps"):
                    np.testing.assert_array_equal(group[column][()], [case[column] for case in series["cases"]])
                np.testing.assert_array_equal(group["rejected"][()],
                                              [case.get("rejected", 0) for case in series["cases"]])
        self.assertGreater(sum(case.get("rejected", 0) for case in result["series"][1]["cases"]), 0)
        explained = self.acstudy("explain", "tiny.toml")
        self.assertEqual((explained.returncode, explained.stderr), (0, ""))
        self.assertIn("time: sdirk3, step adaptive to 0.001\n", explained.stdout)
        self.assertIn("dt: of the first step that is tried; steps: a guess", explained.stdout)

    def test_equal_steps_say_nothing_of_it(self):
        done = self.run_study(STUDY, "-v")
        self.assertNotIn("rejected", done.stdout)
        for case in self.result()["series"][0]["cases"]:
            self.assertNotIn("tolerance", case)
            self.assertNotIn("rejected", case)

    def test_the_bound_is_watched_and_not_complained_of(self):
        """Explicit adaptive steps go beyond the lemma of Model II where they may."""
        text = adaptive("ssprk3", "1e-2", study=edit(STUDY, MODEL_II, ("[16, 32, 64]", "[64, 128]")))
        done = self.run_study(text)
        self.assertEqual(done.stderr, "")
        for case in self.result()["series"][0]["cases"]:
            self.assertGreater(case["bound"]["largest"], 1)

    def test_a_solution_that_ends_ends_the_steps(self):
        nowhere = 'u = "cos(x-t) + 0*sqrt((t-0.5)^2 - 0.0025)"'
        text = edit(adaptive("ssprk3", "1e-4", study=INLINE), ('u = "cos(x-t)"', nowhere))
        for form in ("readable", "vector"):
            with self.subTest(form):
                self.run_study(text, "--form", form, out=form, expect=3)
                for case in self.result(out=form)["series"][0]["cases"]:
                    self.assertRegex(case["failure"], "the time step has become too small to advance time: at no length "
                                                      "was its estimated error tolerated in step [0-9]+, from t = 0.45 on")
                    self.assertAlmostEqual(case["last"]["time"], 0.45, delta=1e-9)
                    self.assertIsNone(case["error_linf"])

    def test_a_limit_of_time_holds(self):
        text = edit(adaptive("ssprk3", "1e-12", 'limit = "0.01 s"'), ("[16, 32, 64]", "[16, 2560]"))
        self.run_study(text, expect=3)
        self.assertIn("took longer than its limit of 0.01 s", self.result()["series"][0]["cases"][1]["failure"])

    def test_what_is_stored_is_taken_for_the_same_tolerance_alone(self):
        text = adaptive("sdirk2", "1e-3")
        self.assert_counts(self.run_study(text), 3, 0)
        self.assert_counts(self.run_study(text), 0, 3)
        self.assert_counts(self.run_study(adaptive("sdirk2", "1e-4")), 3, 0)
        self.assert_counts(self.run_study(adaptive("sdirk2", "1e-4", 'first = "h/8"')), 3, 0)

    def test_cases_are_timed(self):
        self.write("tiny.toml", adaptive("sdirk2", "[1e-2, 1e-4]", "first = 1"))
        done = self.acstudy("bench", "tiny.toml", "--out", "out", "--runs", "1", "--least-seconds", "0")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        cases = json.loads((self.folder / "out" / "bench.json").read_text(encoding="utf-8"))["cases"]
        self.assertEqual([case["tolerance"] for case in cases], [1e-2] * 3 + [1e-4] * 3)
        self.assertTrue(all(case["steps"] > 0 and case["seconds"]["median"] > 0 for case in cases))
        self.assertTrue(any(case.get("rejected", 0) > 0 for case in cases))

    def test_no_budget_of_errors_is_made(self):
        self.write("tiny.toml", adaptive("ssprk3", "1e-4"))
        self.write("parts.toml", '[study]\nname = "parts"\nkind = "pollution"\n[pollution]\nstudies = ["tiny.toml"]\n')
        self.assert_bad_input(
            self.acstudy("explain", "parts.toml"),
            'parts.toml:5:12: studies contains "tiny.toml", whose steps are adaptive; the part of time is seen by halving '
            'them, so name one with an expression such as step = "h/2"')

    def test_a_kind_with_one_way_to_step_takes_one_tolerance(self):
        plane = '[map]\ndelta = [0.1, 0.2, 0.4, 0.8]\nN = [20, 40, 80, 160]\nsources = ["local"]\n'
        text = edit(STUDY[:STUDY.index("[[path]]")], ('title =', 'kind = "map"\ntitle =')) + plane
        self.write("map.toml", edit(text, (*EQUAL, 'integrator = "ssprk3"\nstep = "adaptive"\ntolerance = [1e-2, 1e-3]')))
        done = self.acstudy("explain", "map.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("leave one [[time]], and one tolerance where steps are adaptive", done.stderr)
        self.write("map.toml", edit(text, (*EQUAL, 'integrator = "ssprk3"\nstep = "adaptive"\ntolerance = 1e-2')))
        self.assertEqual(self.acstudy("explain", "map.toml").returncode, 0)


if __name__ == "__main__":
    unittest.main()
