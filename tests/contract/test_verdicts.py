"""Verdicts as exit codes, of the run and of the gate."""

import json
import math
import subprocess
import unittest

from tests.program import ACSTUDY, GOOD, LEVELS, MODEL_II, STUDY, USE, ProgramTest, edit


class Gate(ProgramTest):
    """check and the exit codes of run."""

    GOOD_SERIES = "Model I, local divergence, inverse, delta = 4h"
    # Beyond the CFL bound by a factor of about 6, with enough steps to blow up.
    UNSTABLE = edit(STUDY, ('"h/4"', '"5*h"'), (LEVELS, "[320, 640, 1280]"))
    # A viscosity at which one step multiplies the shortest wave by hundreds: past the largest number long before T.
    OVERFLOWING = edit(STUDY, MODEL_II, ('"cubic-spline"', '"cubic-spline"\nmu = 1000'), (LEVELS, "[320, 640, 1280]"))

    def tampered(self, change):
        """Runs check on a good result with a change made to its first series."""
        self.run_study(GOOD, expect=0)
        result = self.result()
        change(result["series"][0])
        self.write("tampered.json", json.dumps(result))
        return self.acstudy("check", "-v", "tampered.json")

    def test_good_results_pass(self):
        done = self.tampered(lambda series: None)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, rf"\Agate .*\nok +tiny +{self.GOOD_SERIES} .* confirmed *\n"
                                      r"1 gates, 0 depart\n\Z")

    def test_nothing_bad_passes(self):
        def error(level, change):
            def apply(series):
                case = series["cases"][level]
                case["error_linf"] = change(case["error_linf"])
            return apply

        def drop(count):
            return lambda series: series["cases"].__delitem__(slice(0, count))

        def drop_all_traces(count):
            def apply(series):
                del series["cases"][:count]
                series["cases_planned"] -= count
            return apply

        for what, change in {
                "an error is not a number": error(1, lambda e: None),
                "the finest error is not a number": error(-1, lambda e: None),
                "an error in the middle is inflated": error(2, lambda e: 3 * e),
                "the finest error is inflated": error(-1, lambda e: 1.2 * e),
                "the finest error is too good": error(-1, lambda e: e / 2),
                "one huge error at the finest level": error(-1, lambda e: 1e30),
                "a negative error": error(0, lambda e: -e),
                "an error of zero": error(1, lambda e: 0.0),
                "all errors equal": lambda series: [case.update(error_linf=0.1) for case in series["cases"]],
                "one level is missing": drop(1),
                "two levels are missing, and nothing says so": drop_all_traces(2),
                "no level is left": drop_all_traces(4),
                "the levels are in disorder": lambda series: series["cases"].reverse(),
                "the verdict is another": lambda series: series.update(verdict="above"),
                "the verdict is none": lambda series: series.update(verdict="excellent"),
                "another verdict is expected": lambda series: series.update(expected="above"),
                "theory has another order": lambda series: series["theory"].update(order=2.0)}.items():
            with self.subTest(what):
                done = self.tampered(change)
                self.assertEqual((done.returncode, done.stderr), (1, ""), done.stdout)
                self.assertRegex(done.stdout, rf"\Agate .*\nDEPART +tiny +{self.GOOD_SERIES} ")
                self.assertIn("1 gates, 1 depart", done.stdout)

    def test_one_bad_file_of_several_fails(self):
        self.run_study(GOOD, expect=0)
        self.run_study(edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "above"')), out="other", expect=1)
        for files in (("out/tiny.json", "other/tiny.json"), ("other/tiny.json", "out/tiny.json")):
            done = self.acstudy("check", *files)
            self.assertEqual(done.returncode, 1)
            self.assertIn("2 gates, 1 depart", done.stdout)

    def test_run_and_check_agree_on_a_wrong_expectation(self):
        text = edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "above"'))
        done = self.run_study(text, expect=1)
        self.assertRegex(done.stdout, r"DEPART [^\n]+\n[^\n]+ confirmed, expected above")
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)
        self.run_study(text, expect=1)

    def test_a_blow_up_is_3_unless_it_is_expected(self):
        for text in (self.UNSTABLE, self.OVERFLOWING):
            done = self.run_study(text, expect=3)
            self.assertRegex(done.stdout, r"DEPART [^\n]+\n +unstable, expected confirmed: ")
            self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)
            expected = edit(text, ('source = "local"', 'source = "local"\nexpect = "unstable"'))
            self.assert_counts(self.run_study(expected, expect=0), 0, 3)
            self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 0)

    def test_errors_of_a_run_that_overflowed_are_null(self):
        self.run_study(self.OVERFLOWING, expect=3)
        series, = self.result()["series"]
        for case in series["cases"]:
            self.assertIsNone(case["error_linf"])
            self.assertIn("the solution has grown to", case["blow_up"])
        self.assertEqual(series["observed"]["pairwise"], [None, None])
        self.assertEqual(series["verdict"], "unstable")

    def test_steps_beyond_the_bound_are_noted_and_judged_by_what_happens(self):
        # Gaps close like exp(-t): h/4 keeps the bound until t = log 3.
        done = self.run_study(edit(STUDY, (USE, USE + "\nT = 1.5"), ('"h/4"', '"h/4"\nexpect = "stable"')), expect=0)
        self.assertRegex(done.stderr, r"\Aacstudy: note: tiny: steps of 1 of 1 series are beyond the bound of Lemma 2\.4, "
                                      r"by a factor of up to 1\.\d+\n\Z")
        for case in self.result()["series"][0]["cases"]:
            self.assertGreater(case["bound"]["largest"], 1.25)
            self.assertGreater(case["bound"]["first_step"], 1)
            self.assertAlmostEqual(case["bound"]["first_place"], math.pi, delta=0.3)
            self.assertAlmostEqual(case["bound"]["first_time"], math.log(3), delta=0.2)

    def test_stable_expects_no_order_but_a_bounded_solution(self):
        stable = ('source = "local"', 'source = "local"\nexpect = "stable"')
        self.run_study(edit(GOOD, stable), expect=0)
        self.run_study(edit(self.UNSTABLE, stable), expect=3)
        case = self.result()["series"][0]["cases"][-1]
        last, steps = case["last"], case["steps"]
        self.assertIsNone(case["error_linf"])
        self.assertEqual(last["step"], steps)
        self.assertLess(last["time"], 1)
        self.assertGreater(last["error_linf"], 1e5)
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)

    def test_a_map_whose_runs_blow_up_fails_numerically(self):
        unstable = edit(STUDY[:STUDY.index("[[path]]")], ('name = "tiny"', 'name = "tiny"\nkind = "map"'), ('"h/4"', '"3*h"'))
        done = self.run_study(unstable + '[map]\ndelta = [0.001, 0.002, 0.004, 0.008]\nN = [160, 320, 640, 1280]\n'
                                         'sources = ["local"]\n', expect=3)
        self.assertIn("unstable, expected confirmed", done.stdout)

    def test_stable_is_no_error_of_many_times_the_solution(self):
        # Beyond the bound for a few steps: too few to blow up, enough to be of no use.
        few = edit(STUDY, ('"h/4"', '"3*h"'), ('"4*h"', '"h^2"'), (LEVELS, "[80, 120]"),
                   ('source = "local"', 'source = "local"\nexpect = "stable"'))
        self.run_study(few, expect=0)
        data = self.result()
        for case in data["series"][0]["cases"]:
            self.assertAlmostEqual(case["solution_linf"], 1, delta=0.01)
        data["series"][0]["cases"][1]["error_linf"] = 101.0
        self.write("out/tiny.json", json.dumps(data))
        checked = self.acstudy("check", "-v", "out/tiny.json")
        self.assertEqual(checked.returncode, 1)
        self.assertIn("an error is 101, that of a solution of 1 at most", checked.stdout)

    def test_each_way_to_step_is_a_series_with_its_own_expectation(self):
        moving = edit(STUDY, ('kernel = "inverse"', 'kernel = "cubic-spline"'), ('"4*h"', '"h^2"'),
                      (LEVELS, "[80, 160, 320, 640]"))
        ways = ('[time]\nintegrator = "forward-euler"\nstep = "h/4"',
                '[[time]]\nintegrator = "forward-euler"\nstep = "cfl"\nsafety = 0.5\n'
                '[[time]]\nintegrator = "sdirk2"\nstep = "h"\nexpect = "stable"')
        done = self.run_study(edit(moving, ways), expect=0)
        self.assertEqual(done.stderr, "")
        first, second = self.result()["series"]
        self.assertEqual((first["stepping"], first["expected"]), ("forward-euler, step 0.5 cfl", "confirmed"))
        self.assertEqual((second["stepping"], second["expected"]), ("sdirk2, step h", "stable"))
        for case in first["cases"]:
            self.assertLess(case["dt_smallest"], case["dt"])
            self.assertLessEqual(case["bound"]["largest"], 0.5 + 1e-12)
        checked = self.acstudy("check", "-v", "out/tiny.json")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        self.assertIn("delta = 4h, sdirk2, step h ", checked.stdout)
        self.assert_counts(self.run_study(edit(moving, ways), expect=0), 0, 8)

    def test_unstable_expected_but_stable_departs(self):
        self.run_study(edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "unstable"')), expect=1)


class NotComputed(ProgramTest):
    """A case without a solution is no blow-up, and takes nothing else with it."""

    ROUGH = edit(STUDY, (USE, 'period = "2*pi"\nT = 1\nc = "1"\nu = "cos(400*x)"'), ('"4*h"', "2.5"),
                 ('source = "local"', 'source = "nonlocal"'))

    def test_it_is_inconclusive_and_exits_3_even_where_a_blow_up_is_expected(self):
        for text in (self.ROUGH, edit(self.ROUGH, ('"nonlocal"', '"nonlocal"\nexpect = "unstable"'))):
            done = self.run_study(text, "--fresh", "-v")
            self.assertEqual(done.returncode, 3, done.stdout)
            self.assertIn("inconclusive", done.stdout)
            self.assertIn("a case could not be computed: no Gauss rule", done.stdout)
            self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)

    def test_a_closed_stderr_changes_no_exit_code(self):
        done = subprocess.run(["sh", "-c", f"'{ACSTUDY}' run none.toml 2>&-"], cwd=self.folder)
        self.assertEqual(done.returncode, 2)


if __name__ == "__main__":
    unittest.main()
