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


class FitTest(ProgramTest):
    def fit(self, text, *arguments):
        self.write("table.csv", text)
        return self.acstudy("fit", "table.csv", *arguments)

    def judged(self, text, *arguments, code):
        done = self.fit(text, "--json", *arguments)
        self.assertEqual((done.returncode, done.stderr), (code, ""), done.stdout)
        return json.loads(done.stdout, parse_constant=self.fail)


class VerdictTest(FitTest):
    def test_exit_code_is_zero_only_for_the_order_asked_for(self):
        for order, code, verdict in (("1", 0, "confirmed"), ("2", 1, "below"), ("0.5", 1, "above"),
                                     ("0", 1, "inconclusive")):
            result = self.judged(table(power(1)), "--order", order, code=code)
            self.assertEqual((result["verdict"], result["theory_order"]), (verdict, float(order)))
        self.assertEqual(self.judged(table(power(1, -3.9)), "--order", "1", code=0)["verdict"], "pre-asymptotic")
        settling = table([0.01 + 0.001 * v for v in HALVED])
        self.assertEqual(self.judged(settling, "--order", "0", code=0)["verdict"], "stagnates")
        self.assertEqual(self.judged(settling, "--order", "1", code=1)["verdict"], "stagnates")

    def test_without_an_order_nothing_is_confirmed(self):
        result = self.judged(table(power(1)), code=1)
        self.assertEqual((result["verdict"], result["theory_order"]), ("inconclusive", None))
        self.assertIn("no theory's order", result["reason"])
        self.assertAlmostEqual(result["order"], 1, delta=1e-6)
        for errors, verdict in (([1, 2, 4, 8, 16], "diverges"), ([1, 1, 1, 1, 1], "stagnates"),
                                ([1e-2, 1e-6, 1e-10, 1e-14, 1e-15], "floor"), ([1, 0.5, math.nan, 0.1, 0.05], "unstable"),
                                ([1, 0.5, math.inf, 0.1, 0.05], "unstable"), ([1, 0.5, -0.25, 0.1, 0.05], "inconclusive")):
            self.assertEqual(self.judged(table(errors), code=1)["verdict"], verdict)

    def test_the_object_has_every_estimate(self):
        result = self.judged(table(power(1, -3.9)), "--order", "1", code=0)
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
        result = self.judged("h error\n0.1 0.1\n0.05 nan\n0.025 0.02\n", "--order", "1", code=1)
        self.assertEqual((result["verdict"], result["order"], result["pairwise"]), ("unstable", None, [None, None]))
        self.assertIsNone(result["levels"][1]["error"])
        self.assertIsNone(result["extrapolated"]["order"])
        self.assertIsNone(result["leave_one_out"]["level"])

    def test_too_few_or_repeated_levels_are_inconclusive(self):
        for rows in ("0.1,0.1\n", "0.1,0.1\n0.05,0.05\n", "0.1,0.1\n0.05,0.05\n0.05,0.05\n0.025,0.025\n"):
            self.assertEqual(self.judged("h,error\n" + rows, "--order", "1", code=1)["verdict"], "inconclusive")

    def test_an_outlier_is_named_unless_it_weighs_nothing(self):
        errors = power(1)
        errors[2] *= 1.5
        result = self.judged(table(errors), "--order", "1", code=1)
        self.assertEqual(result["verdict"], "inconclusive")
        self.assertIn("level 3", result["reason"])

    def test_the_table_for_people_says_the_same(self):
        done = self.fit(table(power(1, -3.9)), "--order", "1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for words in ("level", "0.00625", "error = C h^p (1 + D h^q)", "q = 1", "error = C h^p + F", "levels 1 to 5",
                      "pre-asymptotic (order 1): pairwise orders"):
            self.assertIn(words, done.stdout)


class TableTest(FitTest):
    def test_separators_comments_order_and_line_ends_do_not_matter(self):
        expected = self.judged(table(power(1)), code=1)
        rows = table(power(1)).splitlines()
        for text in (table(power(1), ";"), table(power(1), "\t"), table(power(1), "  "), table(power(1), " , "),
                     "\n".join([rows[0]] + rows[:0:-1]), "\r\n".join(rows), "\ufeff" + "\n".join(rows),
                     "# made by hand\n\n" + "\n".join(f"{row}  # so it is" for row in rows) + "\n\n",
                     table(power(1), header=('"h"', '"error"'))):
            self.assertEqual(self.judged(text, code=1), expected, text)

    def test_columns_have_names(self):
        text = "N;L2;spacing;n\n" + "".join(f"{i};{e!r};{v!r};{1 + i}\n" for i, (v, e) in enumerate(zip(HALVED, power(2))))
        result = self.judged(text, "--variable", "spacing", "--error", "L2", "--weight", "n", "--order", "2", code=0)
        self.assertEqual([level["weight"] for level in result["levels"]], [1, 2, 3, 4, 5])
        self.assert_bad_input(self.fit(text), 'table.csv:1:1: no column "h"; the columns are N, L2, spacing, n; '
                                              "name one with --variable")

    def test_what_cannot_be_read_is_named_by_line_and_column(self):
        not_a_number = "not a number that a double can hold; write one such as 1.5e-3, nan or inf"
        positive = "it must be positive and finite; correct it or leave the row out"
        for text, message in (
                ("h,error\n0.1,abc\n", f'2:5: error = "abc"; {not_a_number}'),
                ("h,error\n0.1, 1e999\n", f'2:6: error = "1e999"; {not_a_number}'),
                ("h,error\n0.1,\n", '2:5: error = ""; the cell is empty; write a number there or leave the row out'),
                ("h,error\n0.1,0.2x\n", f'2:5: error = "0.2x"; {not_a_number}'),
                ("h;error\n0,1;0.2\n", '2:1: h = "0,1"; a decimal comma; write a point'),
                ("h,error\n-0.1,0.2\n", f"2:1: h = -0.1; {positive}"),
                ("h,error\nnan,0.2\n", f"2:1: h = nan; {positive}"),
                ("h,error\n# x\n0.1,0.2,3\n",
                 "3:1: 3 value(s), but the header names 2 column(s); write one value for each"),
                ("h,error,h\n1,2,3\n", '1:9: a second column "h"; name each once'),
                ("h,error\n", "1:1: the table has a header and no rows; write a row for each level"),
                ("# nothing\n", "1:1: the table has no header; write the names of the columns in its first line")):
            self.assert_bad_input(self.fit(text), f"table.csv:{message}")
        missing = "cannot read a table there; name a file whose first line names its columns"
        for file in ("none.csv", "."):
            self.assert_bad_input(self.acstudy("fit", file), f"{file}: {missing}")

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
