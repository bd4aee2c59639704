"""acstudy fit, as a user meets it: any table of errors, judged against an order or against none."""

import json
import math
import unittest

from tests.program import ProgramTest

HALVED = [0.1, 0.05, 0.025, 0.0125, 0.00625]


def table(errors, separator=",", variables=HALVED, header=("h", "error")):
    lines = [separator.join(header)] + [f"{v!r}{separator}{e!r}" for v, e in zip(variables, errors)]
    return "\n".join(lines) + "\n"


def power(p, D=0.0):
    return [0.3 * v ** p * (1 + D * v) for v in HALVED]


class VerdictTest(ProgramTest):
    def test_exit_code_is_zero_only_for_the_order_asked_for(self):
        for order, code, verdict in (("1", 0, "confirmed"), ("2", 1, "below"), ("0.5", 1, "above"),
                                     ("0", 1, "above")):
            result = self.fitted(table(power(1)), "--order", order, code=code)
            self.assertEqual((result["verdict"], result["theory_order"]), (verdict, float(order)))
        self.assertEqual(self.fitted(table(power(1, -3.9)), "--order", "1", code=0)["verdict"], "pre-asymptotic")
        settling = table([0.01 + 0.001 * v for v in HALVED])
        self.assertEqual(self.fitted(settling, "--order", "0", code=0)["verdict"], "stagnates")
        self.assertEqual(self.fitted(settling, "--order", "1", code=1)["verdict"], "stagnates")

    def test_without_an_order_a_sharp_one_is_determined(self):
        result = self.fitted(table(power(1)), code=0)
        self.assertEqual((result["verdict"], result["theory_order"]), ("determined", None))
        self.assertIn("no theory's order", result["reason"])
        self.assertAlmostEqual(result["order"], 1, delta=1e-6)
        for errors, verdict in (([1, 2, 4, 8, 16], "diverges"), ([1, 1, 1, 1, 1], "stagnates"),
                                ([1e-2, 1e-6, 1e-10, 1e-14, 1e-14], "floor"), ([1, 0.5, math.nan, 0.1, 0.05], "unstable"),
                                ([1, 0.5, math.inf, 0.1, 0.05], "unstable"), ([1, 0.5, -0.25, 0.1, 0.05], "inconclusive")):
            self.assertEqual(self.fitted(table(errors), code=1)["verdict"], verdict)

    def test_the_object_has_every_estimate(self):
        result = self.fitted(table(power(1, -3.9)), "--order", "1", code=0)
        self.assertEqual(len(result["pairwise"]), 4)
        self.assertEqual([level["variable"] for level in result["levels"]], HALVED)
        self.assertEqual(result["window"], {"first": 1, "last": 5})
        self.assertAlmostEqual(result["extrapolated"]["order"], 1, delta=1e-4)
        self.assertAlmostEqual(result["extrapolated"]["D"], -3.9, delta=1e-2)
        self.assertEqual(result["extrapolated"]["q"], 1)
        self.assertEqual(result["order"], result["extrapolated"]["order"])
        self.assertLess(result["fitted"]["order"], 0.95)
        self.assertLessEqual({"order", "low", "high", "F"}, result["floor"].keys())
        self.assertEqual(result["leave_one_out"]["level"], 1)

    def test_what_is_not_finite_is_null(self):
        result = self.fitted("h error\n0.1 0.1\n0.05 nan\n0.025 0.02\n", "--order", "1", code=1)
        self.assertEqual((result["verdict"], result["order"], result["pairwise"]), ("unstable", None, [None, None]))
        self.assertIsNone(result["levels"][1]["error"])
        self.assertIsNone(result["extrapolated"]["order"])
        self.assertIsNone(result["leave_one_out"]["level"])

    def test_too_few_or_repeated_levels_are_inconclusive(self):
        for rows in ("0.1,0.1\n", "0.1,0.1\n0.05,0.05\n", "0.1,0.1\n0.05,0.05\n0.05,0.05\n0.025,0.025\n"):
            self.assertEqual(self.fitted("h,error\n" + rows, "--order", "1", code=1)["verdict"], "inconclusive")

    def test_an_outlier_is_named_unless_it_weighs_nothing(self):
        errors = power(1)
        errors[2] *= 1.5
        result = self.fitted(table(errors), "--order", "1", code=1)
        self.assertEqual(result["verdict"], "inconclusive")
        self.assertIn("level 3", result["reason"])

    def test_the_table_for_people_says_the_same(self):
        done = self.fit(table(power(1, -3.9)), "--order", "1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for words in ("level", "0.00625", "error = C h^p (1 + D h^q)", "q = 1", "error = C h^p + F", "levels 1 to 5",
                      "pre-asymptotic (order 1): pairwise orders"):
            self.assertIn(words, done.stdout)


class UnitsTest(ProgramTest):
    def test_units_of_the_errors_decide_nothing(self):
        finer = [2.0 ** -k for k in range(3, 11)]
        for order, variables, errors in (
                ("1", HALVED, power(1)), ("2", HALVED, power(1)), ("1", HALVED, power(1, -3.9)),
                ("1", HALVED, [0.01 + 0.001 * v for v in HALVED]), ("0", HALVED, [0.01 + 0.001 * v for v in HALVED]),
                ("3", finer, [float(f"{2e-4 * v ** 3 * (1 + 0.2 * v):.2e}") for v in finer]),
                ("2", finer, [float(f"{0.05 * v ** 2 * (1 + 2 * v):.3e}") for v in finer]),
                ("2", finer, [0.05 * v ** 2 * (1 + 0.02 * (-1) ** i) for i, v in enumerate(finer)])):
            results = [self.fit(table([unit * e for e in errors], variables=variables), "--json", "--order", order)
                       for unit in (1, 1e-9, 1e9)]
            expected, *others = [(done.returncode, json.loads(done.stdout)) for done in results]
            for code, result in others:
                self.assertEqual((code, result["verdict"], result["window"]),
                                 (expected[0], expected[1]["verdict"], expected[1]["window"]), errors)
                for key in ("order", "low", "high"):
                    self.assertAlmostEqual(result[key], expected[1][key], delta=1e-4)


class RequestTest(ProgramTest):
    COLUMNS = "N;L2;max, scaled;rate;run\n" + "".join(
        f"{n};{0.1 / n ** 2!r};{0.3 / n!r};{'-' if n == 10 else 2};a\n" for n in (10, 20, 40, 80, 160))

    def test_several_columns_are_judged_at_once(self):
        alone = self.fitted(self.COLUMNS, "--count", "N", "--error", "L2", "--order", "2", code=0)
        self.assertEqual((alone.pop("column"), alone.pop("count"), alone.pop("dimension")), ("L2", "N", 1))
        for asked in (("--error", "L2", "--error", "max, scaled"), ("--error", "all")):
            result = self.fitted(self.COLUMNS, "--count", "N", *asked, "--order", "2", code=1)
            self.assertEqual([(c.pop("error"), c["verdict"]) for c in result["columns"]],
                             [("L2", "confirmed"), ("max, scaled", "below")])
            self.assertEqual(result["columns"][0], alone)
            self.assertEqual(result["left_out"], ["2:15: rate = -", "2:17: run = a"] if "all" in asked else [])
        text = table(power(1), header=("h", "l1"))
        both = "\n".join(f"{row},{'l2' if row.startswith('h') else row.split(',')[1]}" for row in text.splitlines())
        self.assertEqual(len(self.fitted(both, "--error", "l1, l2", "--order", "1", code=0)["columns"]), 2)
        done = self.fit(both, "--error", "l1,l2", "--order", "1")
        self.assertEqual((done.returncode, done.stdout.count("confirmed (order 1)")), (0, 2))
        self.assert_bad_input(self.fit(both, "--error", "l1,l3"),
                              'table.csv:1:1: no column "l3"; the columns are h, l1, l2; name one with --error')
        self.assert_bad_input(self.fit("h,error\n0.1,x\n", "--error", "all"),
                              "--error all; no column but those of variable, count and weight holds numbers")

    def test_all_columns_may_have_columns_of_the_same_name(self):
        text = "h,l2,order,linf,order\n" + "".join(f"{v!r},{v!r},2,{2 * v!r},2\n" for v in HALVED)
        result = self.fitted(text, "--error", "all", "--order", "1", code=1)
        self.assertEqual([column["error"] for column in result["columns"]], ["l2", "order", "linf", "order"])
        self.assert_bad_input(self.fit(text, "--error", "order"), 'table.csv:1:17: a second column "order"; name each once')

    def test_levels_are_chosen_coarse_to_fine(self):
        errors = [0.3 * v for v in HALVED]
        errors[0] = 7.0
        rows = table(errors).splitlines()
        text = "\n".join([rows[0]] + rows[:0:-1])
        for levels, chosen, words in (("2:", HALVED[1:], "levels 2 to 5 of 5, as asked, here counted from 1"),
                                      (":3", HALVED[:3], "levels 1 to 3 of 5, as asked"),
                                      ("2:4", HALVED[1:4], "levels 2 to 4 of 5, as asked, here counted from 1")):
            result = self.fitted(text, "--levels", levels, "--order", "1", code=levels == ":3")
            self.assertEqual([level["variable"] for level in result["levels"]], chosen)
            self.assertTrue(result["reason"].endswith(words), result["reason"])
        for levels in ("", ":", "3", "0:", "2:6", "4:3", "a:b", "1:2:3", "-1:", "1.5:"):
            done = self.fit(text, f"--levels={levels}")
            if levels:
                self.assert_bad_input(done, f'--levels = "{levels}"; the table has levels 1, the coarsest, to 5; '
                                            "write A:B, A: or :B of these")

    def test_counts_of_cells_become_the_variable(self):
        cells = [2 ** (2 * k) for k in range(2, 8)]
        text = table([3 / n for n in cells], variables=cells, header=("cells", "error"))
        result = self.fitted(text, "--count", "cells", "--dimension", "2", "--order", "2", code=0)
        self.assertEqual([level["variable"] for level in result["levels"]], [2.0 ** -k for k in range(2, 8)])
        self.assertIn("h = cells^(-1/2)", self.fit(text, "--count", "cells", "--dimension", "2").stdout)
        self.assertAlmostEqual(self.fitted(text, "--count", "cells", "--order", "1", code=0)["order"], 1)
        hint = ("the variable cells grows as the errors fall; if it counts cells, write --count cells --dimension D, "
                "so that h = cells^(-1/D)")
        for order in ((), ("--order", "2"), ("--order", "0")):
            result = self.fitted(text, "--variable", "cells", *order, code=1)
            self.assertEqual((result["verdict"], result["reason"]), ("inconclusive", hint))
        broken = table([3 / n for n in cells[:-2]] + [math.nan, 3], variables=cells)
        self.assertEqual(self.fitted(broken, "--variable", "h", code=1)["verdict"], "unstable")
        scaled = table([3 / n for n in cells], variables=[n / 3 for n in cells])
        self.assertIn("; the variable h grows as", self.fitted(scaled, code=1)["reason"])
        self.assertEqual(self.fitted(table([1, 2, 4, 8, 16]), code=1)["verdict"], "diverges")
        self.assertNotIn("--count", self.fitted(table([1, 2, 4, 8, 16]), code=1)["reason"])

    def test_above_names_its_remedy(self):
        for p, order in ((2, "2"), (1.52, "1.5"), (1.75, "1.75")):
            reason = self.fitted(table(power(p)), "--order", "0.5", code=1)["reason"]
            self.assertIn(f"theorems are upper bounds: write --order {order} to ask for the order that is seen", reason)

    def test_numbers_of_the_command_line_are_checked(self):
        positive = "it must be positive and finite; write"
        for option, value, rest in (("--scale", "0", f"{positive} the size of the solution, as the largest |u|"),
                                    ("--floor", "inf", f"{positive} the error that round-off, quadrature or iteration leaves")):
            self.assert_bad_input(self.fit(table(power(1)), option, value), f"{option} = {value}; {rest}")
        self.assert_bad_input(self.fit(table(power(1)), "--count", "h", "--dimension", "0.5"),
                              "--dimension = 0.5; it must be finite and at least 1; "
                              "write that of the space that the cells fill")
        for arguments in (("--dimension", "2"), ("--count", "h", "--variable", "h")):
            self.assertEqual(self.fit(table(power(1)), *arguments).returncode, 2)

    def test_an_order_is_finite_and_not_negative(self):
        for order in ("-1", "nan", "inf"):
            self.assert_bad_input(self.fit(table(power(1)), "--order", order),
                                  f"--order = {order}; an order must be finite and not negative; "
                                  "write 0 where the error must settle")
        done = self.fit(table(power(1)), "--order", "one")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("acstudy fit --help", done.stderr)


if __name__ == "__main__":
    unittest.main()
