"""acstudy fit --value and --difference, as a user meets them: values whose exact solution is not known."""

import math
import unittest

from tests.program import ProgramTest

HALVED = [0.1, 0.05, 0.025, 0.0125, 0.00625]
UNEVEN = [0.1, 0.071, 0.043, 0.0193, 0.011]


def table(columns, names):
    return "\n".join([",".join(names)] + [",".join(row) for row in zip(*columns)]) + "\n"


def values(variables, law=lambda h: 3 - 0.7 * h ** 2):
    return table([map(repr, variables), [repr(law(h)) for h in variables]], ("h", "phi"))


def differences(variables, law=lambda h: 3 - 0.7 * h ** 2, end=("",)):
    rows = [repr(abs(law(a) - law(b))) for a, b in zip(variables, variables[1:])] + list(end)
    return table([map(repr, variables), rows], ("h", "d"))


class ValueTest(ProgramTest):
    def test_exit_code_is_zero_only_for_the_order_asked_for(self):
        for variables in (HALVED, UNEVEN):
            for order, code, verdict in (("2", 0, "confirmed"), ("1", 1, "above"), ("3", 1, "below")):
                result = self.fitted(values(variables), "--value", "phi", "--order", order, code=code)
                self.assertEqual((result["verdict"], result["theory_order"]), (verdict, float(order)))

    def test_a_sharp_order_is_determined_without_theory(self):
        result = self.fitted(values(HALVED), "--value", "phi", code=0)
        self.assertEqual((result["verdict"], result["theory_order"]), ("determined", None))

    def test_the_object_has_every_estimate(self):
        result = self.fitted(values(UNEVEN), "--value", "phi", "--order", "2", code=0)
        self.assertAlmostEqual(result["order"], 2, delta=1e-6)
        self.assertEqual(len(result["pairwise"]), 3)
        self.assertAlmostEqual(result["extrapolated"], 3, delta=1e-9)
        self.assertLessEqual(result["extrapolated_low"], result["extrapolated"])
        self.assertGreaterEqual(result["extrapolated_high"], result["extrapolated"])
        error = 0.7 * UNEVEN[-1] ** 2
        self.assertEqual(result["safety_factor"], 1.25)
        self.assertAlmostEqual(result["gci_absolute"], 1.25 * error, delta=1e-3 * error)
        self.assertAlmostEqual(result["gci"], 1.25 * error / 3, delta=1e-3 * error)
        self.assertAlmostEqual(result["uncertainty"], 1.25 * error, delta=1e-3 * error)
        self.assertEqual(result["window"], {"first": 1, "last": 5})
        self.assertEqual([level["variable"] for level in result["levels"]], UNEVEN)
        self.assertEqual(len(result["differences"]), 4)
        self.assertEqual(result["column"], "phi")

    def test_published_numbers(self):
        # Celik et al., J. Fluids Eng. 130 (2008) 078001, table 1: cells of a plane, reattachment length.
        text = "cells,length\n4500,5.863\n8000,5.972\n18000,6.063\n"
        result = self.fitted(text, "--value", "length", "--count", "cells", "--dimension", "2", code=1)
        self.assertEqual((result["verdict"], result["low"], result["uncertainty"]), ("inconclusive", None, None))
        self.assertAlmostEqual(result["order"], 1.53, delta=0.005)
        self.assertAlmostEqual(result["extrapolated"], 6.1685, delta=5e-5)
        self.assertAlmostEqual(result["gci"], 0.022, delta=5e-4)
        self.assertIn("three levels", result["reason"])
        # NASA's tutorial on grid convergence.
        result = self.fitted("h pr\n1 0.97050\n2 0.96854\n4 0.96178\n", "--value", "pr", "--order", "2", code=1)
        self.assertAlmostEqual(result["order"], 1.786170, delta=1e-6)
        self.assertAlmostEqual(result["extrapolated"], 0.971300, delta=1e-6)
        self.assertAlmostEqual(result["gci"], 0.001031, delta=1e-6)

    def test_what_swings_or_runs_away_is_named(self):
        swinging = table([map(repr, HALVED), [repr(3 + (-1) ** i * h * h) for i, h in enumerate(HALVED)]], ("h", "phi"))
        result = self.fitted(swinging, "--value", "phi", "--order", "2", code=1)
        self.assertEqual((result["verdict"], result["safety_factor"]), ("inconclusive", 3))
        self.assertIn("oscillate", result["reason"])
        result = self.fitted(values(HALVED, lambda h: 1 / h), "--value", "phi", "--order", "1", code=1)
        self.assertEqual((result["verdict"], result["extrapolated"], result["gci"]), ("diverges", None, None))
        self.assertIn("the values diverge", result["reason"])
        result = self.fitted(values(HALVED, lambda h: math.nan if h < 0.01 else h), "--value", "phi", code=1)
        self.assertEqual(result["verdict"], "unstable")

    def test_printed_digits_are_a_floor(self):
        text = "h,phi\n0.4,1.16\n0.2,1.04\n0.1,1.01\n0.05,1.00\n0.025,1.00\n"
        result = self.fitted(text, "--value", "phi", "--order", "2", code=1)
        self.assertEqual(result["verdict"], "floor")
        self.assertIn("digits", result["reason"])

    def test_several_columns_and_chosen_levels(self):
        text = table([map(repr, HALVED), [repr(1 + h) for h in HALVED], [repr(1 + h ** 2) for h in HALVED]],
                     ("h", "a", "b"))
        result = self.fitted(text, "--value", "a,b", "--order", "2", code=1)
        self.assertEqual([(c["column"], c["verdict"]) for c in result["columns"]], [("a", "below"), ("b", "confirmed")])
        result = self.fitted(text, "--value", "b", "--levels", "2:", "--order", "2", code=0)
        self.assertEqual(len(result["levels"]), 4)
        self.assertIn("levels 2 to 5 of 5, as asked", result["reason"])

    def test_the_table_for_people_says_the_same(self):
        done = self.fit(values(UNEVEN), "--value", "phi", "--order", "2")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for words in ("difference", "extrapolated value L", "grid convergence index",
                      "safety factor 1.25", "least squares (Eca, Hoekstra)", "confirmed (order 2)"):
            self.assertIn(words, done.stdout)
        self.assertNotRegex(done.stdout, r" \n|nan")
        before_the_verdict = done.stdout.partition("confirmed")[0]
        self.assertNotRegex(before_the_verdict, r"order  |= L \+", "the interval of an order is that of the verdict")


class DifferenceTest(ProgramTest):
    def test_differences_have_order_verdict_and_index_but_no_limit(self):
        for variables in (HALVED, UNEVEN):
            result = self.fitted(differences(variables), "--difference", "d", "--order", "2", code=0)
            self.assertEqual(result["verdict"], "confirmed")
            self.assertAlmostEqual(result["order"], 2, delta=1e-3)
            self.assertLess(result["low"], 2.001)
            error = 0.7 * variables[-1] ** 2
            self.assertAlmostEqual(result["gci"], 1.25 * error, delta=5e-3 * error)
            self.assertEqual((result["extrapolated"], result["uncertainty"]), (None, None))
            self.fitted(differences(variables), "--difference", "d", "--order", "1", code=1)

    def test_the_row_of_the_finest_level_may_be_missing_where_ratios_are_equal(self):
        expected = self.fitted(differences(HALVED), "--difference", "d", "--order", "2", code=0)
        for end in (("-",), ()):
            result = self.fitted(differences(HALVED, end=end), "--difference", "d", "--order", "2", code=0)
            self.assertAlmostEqual(result["gci"], expected["gci"], delta=1e-9 * expected["gci"])
        self.assert_bad_input(
            self.fit(differences(UNEVEN, end=()), "--difference", "d"),
            f"table.csv:5:8: d = {differences(UNEVEN).splitlines()[4].split(',')[1]}; a difference to a level without a "
            "row, and the variables have no one ratio; add a row for the finest level, its difference empty")

    def test_a_difference_may_stand_in_the_row_of_the_finer_level(self):
        coarse = self.fitted(differences(UNEVEN), "--difference", "d", "--order", "2", code=0)
        rows = [row.split(",") for row in differences(UNEVEN).splitlines()]
        shifted = table([[row[0] for row in rows[1:]], [""] + [row[1] for row in rows[1:-1]]], rows[0])
        fine = self.fitted(shifted, "--difference", "d", "--order", "2", code=0)
        self.assertEqual(coarse["differences"], fine["differences"])

    def test_an_empty_difference_in_between_is_bad_input(self):
        done = self.fit("h,d\n0.1,0.4\n0.05,\n0.025,0.1\n0.0125,\n", "--difference", "d")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("table.csv:3:6: d = ", done.stderr)

    def test_options_that_exclude_each_other(self):
        for arguments in (("--value", "d", "--difference", "d"), ("--value", "d", "--error", "d"),
                          ("--difference", "d", "--weight", "h")):
            done = self.fit(differences(HALVED), *arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("acstudy fit --help", done.stderr)
        self.assert_bad_input(self.fit(values(HALVED), "--value", "psi"),
                              'table.csv:1:1: no column "psi"; the columns are h, phi; name one with --value')


if __name__ == "__main__":
    unittest.main()
