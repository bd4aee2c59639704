"""Error tables that others have published, and a few of known laws: what the judge may say of each, in any units.

`published/index.csv` has a row for every column of errors and order that is asked for. `variable` is a column, or a
column to a power where the source counts cells; `right` lists the verdicts that may be given, all others are wrong;
`names`, if any, must stand in the reason. What is right was decided from the pairwise orders of the finest levels and
theory, before any judge was asked, and `why` says how. Each question takes a start of the program, so only the first
row of a table is asked in all units.
"""

from concurrent.futures import ThreadPoolExecutor
import csv
from decimal import Decimal
from itertools import groupby
import json
import math
import os
from pathlib import Path
import unittest

from tests.program import ProgramTest

PUBLISHED = Path(__file__).resolve().parent / "published"
VERDICTS = {"confirmed", "pre-asymptotic", "below", "above", "stagnates", "floor", "diverges", "unstable", "inconclusive"}
UNITS = {"": 0, "1e-9 ": -9, "1e9 ": 9}


def rows_of(name):
    """The rows of a table as printed, without the line that names its source."""
    with open(PUBLISHED / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def index():
    with open(PUBLISHED / "index.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def levels(row, decimals=0):
    """Variable and error of each level as text: errors keep their printed digits, moved by a number of decimals."""
    column, _, power = row["variable"].partition("^")
    for level in rows_of(row["table"]):
        variable = repr(float(level[column]) ** float(power)) if power else level[column]
        yield variable, f"{Decimal(level[row['error']]).scaleb(decimals):e}"


def pairwise(row):
    points = [(math.log(float(v)), math.log(float(e)) if float(e) > 0 else math.nan) for v, e in levels(row)]
    return " ".join(f"{(e - f) / (v - w):.2f}" for (v, e), (w, f) in zip(points, points[1:]))


class PublishedTest(ProgramTest):
    def judged(self, row, decimals):
        lines = [f"{variable},{error}\n" for variable, error in levels(row, decimals)]
        name = f"{row['table']}-{row['error']}-{row['order']}-{decimals}.csv"
        self.write(name, "h,error\n" + "".join(lines))
        done = self.acstudy("fit", name, "--order", row["order"], "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return json.loads(done.stdout)

    def wrong(self, row, unit):
        """What is wrong with the verdict on a row, or None."""
        result = self.judged(row, UNITS[unit])
        if result["verdict"] in row["right"].split() and row["names"] in result["reason"]:
            return None
        expected = " or ".join(row["right"].split()) + (f', naming "{row["names"]}"' if row["names"] else "")
        return (f"{unit}{row['table']} {row['error']}, order {row['order']}: {result['verdict']}, expected {expected}\n"
                f"    pairwise {pairwise(row)}: {row['why']}\n    reason given: {result['reason']}")

    def test_every_table_has_a_right_verdict_in_any_units(self):
        asked = []
        for _, rows in groupby(index(), lambda row: row["table"]):
            first, *others = rows
            asked += [(first, unit) for unit in UNITS] + [(row, "") for row in others]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            answers = list(pool.map(lambda case: self.wrong(*case), asked))
        faults = [answer for answer in answers if answer]
        if faults:
            self.fail(f"right in {len(asked) - len(faults)} of {len(asked)}\n" + "\n".join(faults))


class IndexTest(unittest.TestCase):
    def test_index_and_tables_belong_together(self):
        rows = index()
        self.assertEqual({row["table"] for row in rows}, {path.stem for path in PUBLISHED.glob("*.csv")} - {"index"})
        for row in rows:
            self.assertLessEqual(set(row["right"].split()), VERDICTS, row)
            self.assertTrue(row["right"] and row["why"], row)
            self.assertGreaterEqual(len(list(levels(row))), 3, row)
        for path in PUBLISHED.glob("*.csv"):
            self.assertEqual(path.read_text(encoding="utf-8").startswith("# "), path.stem != "index", path)


if __name__ == "__main__":
    unittest.main()
