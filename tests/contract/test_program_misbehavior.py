"""Everything that a program can do wrong is a finding on one case, and nothing else is lost."""

import re
import time
import unittest

from tests.outside_program import Outside


class Misbehavior(Outside):
    def assert_one_case_fails(self, mode, reason, *changes):
        start = time.monotonic()
        done = self.run_mode(mode, *changes, expect=3)
        self.assertLess(time.monotonic() - start, 30)
        series = self.series()
        self.assertEqual([case["N"] for case in series["cases"]], [16, 32, 64, 128])
        for case in series["cases"]:
            if case["N"] == 64:
                self.assertRegex(case["failure"], f"N = 64: python3 solver.py {re.escape(mode)} {reason}")
                self.assertIsNone(case["error_linf"])
            else:
                self.assertNotIn("failure", case)
                self.assertAlmostEqual(case["error_linf"], 0.1 * case["h"], delta=1e-12)
        self.assertEqual(series["verdict"], "inconclusive")
        self.assertIn("N = 64", series["reason"])
        self.assertIn("mine, h alone", done.stdout)
        self.assertIn("N = 64", " ".join(done.stdout.split()))
        return series["cases"][2]

    def test_a_program_that_hangs_is_ended(self):
        self.assert_one_case_fails("hang", r"was ended after its timeout of 1 s", ('"20 s"', '"1 s"'))

    def test_its_children_end_with_it_although_they_hold_the_pipes(self):
        self.assert_one_case_fails("fork and hang", r"was ended after its timeout of 1 s", ('"20 s"', '"1 s"'))
        self.assert_child_is_gone()

    def test_a_child_that_outlives_its_parent_is_ended_and_the_answer_taken(self):
        start = time.monotonic()
        self.run_mode("fork", expect=0)
        self.assertLess(time.monotonic() - start, 15)
        self.assert_child_is_gone()
        self.assertEqual(self.series()["verdict"], "confirmed")

    def test_a_child_that_left_the_group_and_writes_on_is_not_waited_for(self):
        start = time.monotonic()
        self.run_mode("escape")
        self.assertLess(time.monotonic() - start, 4.5)

    def test_a_gigabyte_on_stdout(self):
        case = self.assert_one_case_fails("much", r"was ended after 16 MB on stdout")
        self.assertLess(len(case["failure"]), 1000)

    def test_much_on_stderr_is_read_and_its_end_kept(self):
        self.run_mode("much stderr", expect=0)
        self.assertTrue(self.series()["cases"][2]["stderr"].endswith("ythe end"))
        self.assertLessEqual(len(self.series()["cases"][2]["stderr"]), 2000)

    def test_exit_3_with_the_end_of_stderr(self):
        case = self.assert_one_case_fails("exit 3", r'ended with exit code 3; its stderr ends with "no more\\nmemory .*\\n"')
        self.assertIn("no more\nmemory", case["stderr"])

    def test_a_signal(self):
        self.assert_one_case_fails("signal", r"was ended by signal 11 \(Segmentation fault\)")

    def test_half_a_json(self):
        self.assert_one_case_fails("half", r'wrote 500 bytes to stdout that are not JSON from byte \d+ on, beginning with ')

    def test_words_before_the_json(self):
        self.assert_one_case_fails("words", r'wrote \d+ bytes to stdout that are not JSON from byte 1 on, beginning with '
                                   r'"Solving')

    def test_nothing(self):
        self.assert_one_case_fails("nothing", "wrote nothing to stdout")

    def test_no_object(self):
        self.assert_one_case_fails("list", "wrote JSON that is no object")

    def test_too_few_particles(self):
        self.assert_one_case_fails("few", "gives 63 values of x, and the case has N = 64 particles")
        self.assert_one_case_fails("few values", "gives 63 values of u, and the case has N = 64 particles")

    def test_particles_at_one_place(self):
        self.assert_one_case_fails("twice", r"gives two particles at x = 0\.09817")

    def test_a_place_that_is_none(self):
        self.assert_one_case_fails("nan place", r"gives no finite x\[0\]")

    def test_a_text_for_a_number(self):
        self.assert_one_case_fails("text", r"gives a u\[0\] that is no number")

    def test_keys(self):
        self.assert_one_case_fails("other key", 'gives "error"; known are x, u, file, error_linf')
        self.assert_one_case_fails("both", "has to give x and u, or file, or error_linf, and one of these only")
        self.assert_one_case_fails("negative", "gives error_linf = -0.1; an error is not negative")

    def test_files(self):
        self.assert_one_case_fails("no file", "gives a file that is none: .*nothing.npy cannot be read")
        self.assert_one_case_fails("wrong file", r"gives a file that is none: .*wrong.npy does not hold \(x, u\), float64")

    def test_values_that_are_not_finite_are_an_unstable_scheme(self):
        self.run_mode("nan", expect=3)
        self.assertEqual(self.series()["verdict"], "unstable")
        self.assertIn("N = 64: the solution is not finite at T, at x = 0.49087", self.series()["reason"])
        self.assertNotIn("failure", self.series()["cases"][2])

    def test_a_command_that_is_none(self):
        self.run_mode("good", ('"python3"', '"no-such-program"'), expect=3)
        self.assertEqual([case["failure"] for case in self.series()["cases"]],
                         [f"N = {N}: no-such-program solver.py good cannot be started: No such file or directory"
                          for N in (16, 32, 64, 128)])

    def test_no_shell_reads_the_command(self):
        self.run_mode("good; touch here", expect=0)
        self.assertFalse((self.folder / "here").exists())


if __name__ == "__main__":
    unittest.main()
