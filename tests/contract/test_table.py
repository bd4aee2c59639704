"""acstudy table: errors and orders as papers print them are those of the result file."""

import csv
import io
import json
import math
import re
import shutil
import subprocess
import unittest

from tests.program import STUDY, ProgramTest, edit

SCHEMES = edit(STUDY, ('kernel = "inverse"\n', 'kernel = "inverse"\n\n[[scheme]]\nmodel = 2\ndivergence = "local"\n'
                       'kernel = "cubic-spline"\n'),
               ('source = "local"\n', 'source = "local"\n\n[[path]]\nname = "delta = sqrt(h)"\ndelta = "sqrt(h)"\n'
                'N = [32, 64, 128]\nsource = "local"\nexpect = "inconclusive"\n'))


class TableTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", SCHEMES)
        self.acstudy("run", "study.toml", "--out", "out")
        self.series = json.loads((self.folder / "out" / "tiny.json").read_text(encoding="utf-8"))["series"]

    def table(self, *args):
        done = self.acstudy("table", "out/tiny.json", *args)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_csv_has_all_digits_of_the_result_file(self):
        for norm, key in (("max", "error_linf"), ("l1", "error_l1"), ("l2", "error_l2")):
            rows = list(csv.DictReader(io.StringIO(self.table("--format", "csv", "--norm", norm))))
            stored = [(one["check"], one["subject"], c["N"], c[key]) for one in self.series for c in one["cases"]]
            self.assertCountEqual([(row["conditions"], row["scheme"], int(row["N"]), float(row["error"])) for row in rows],
                                  stored)
            self.assertEqual(len(rows), 12)

    def test_orders_are_those_between_levels(self):
        rows = list(csv.DictReader(io.StringIO(self.table("--format", "csv"))))
        for before, row in zip(rows, rows[1:]):
            if row["order"]:
                ratio = float(before["delta"]) / float(row["delta"])
                order = math.log(float(before["error"]) / float(row["error"])) / math.log(ratio)
                self.assertAlmostEqual(float(row["order"]), order, places=12)
        self.assertEqual([row["order"] == "" for row in rows], [row["N"] in first for row, first in zip(
            rows, 6 * [["16"]] + 6 * [["32"]])])

    def test_markdown_has_a_table_per_path_and_a_column_per_scheme(self):
        text = self.table()
        tables = text.split("\n\n")
        self.assertEqual(tables[0::2], ["delta = 4h", "delta = sqrt(h)"])
        first = [[cell.strip() for cell in line.split("|")[1:-1]] for line in tables[1].splitlines()]
        self.assertEqual(first[0], ["N", "Model I, local divergence, inverse", "order",
                                    "Model II, local divergence, cubic-spline", "order"])
        self.assertEqual([row[0] for row in first[2:]], ["16", "32", "64", "all"])
        self.assertEqual(first[2][1], f"{self.series[0]['cases'][0]['error_linf']:.2e}")
        self.assertEqual(first[5][1], self.series[0]["verdict"])

    def test_uncertain_digits_stand_in_brackets(self):
        by_path = {}
        for one in self.series:
            if all(one["observed"].get(name) is not None for name in ("order", "low", "high")):
                by_path.setdefault(one["path"], []).append(one["observed"])
        printed = re.findall(r" ([-\d.]+)\((\d+)\) \|", self.table())
        known = [observed for path in by_path.values() for observed in path]
        self.assertGreater(len(known), 1)
        for (text, uncertain), observed in zip(printed, known, strict=True):
            half = max(observed["order"] - observed["low"], observed["high"] - observed["order"])
            unit = 10.0**-len(text.partition(".")[2])
            self.assertLessEqual(abs(float(text) - observed["order"]), 0.5 * unit + 1e-12)
            self.assertLessEqual(abs(int(uncertain) * unit - half), 0.5 * unit + 1e-12)

    @unittest.skipUnless(shutil.which("pdflatex"), "there is no pdflatex")
    def test_latex_compiles(self):
        self.write("table.tex", "\\documentclass{article}\\usepackage{booktabs}\\begin{document}\n"
                   + self.table("--format", "latex") + "\\end{document}\n")
        done = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "table.tex"], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_latex_is_whole(self):
        text = self.table("--format", "latex")
        self.assertEqual(text.count("\\begin{tabular}"), 2)
        self.assertIn("$\\delta = \\sqrt{h}$", text)
        for table in re.findall(r"\\midrule\n(.*?)\\bottomrule", text, re.DOTALL):
            for line in table.replace("\\midrule\n", "").splitlines():
                self.assertEqual(line.count("&"), 4)
                self.assertTrue(line.endswith(r" \\"))

    def test_mistakes_are_said(self):
        self.write("bounds.toml", edit(SCHEMES[:SCHEMES.index("[time]")] + "[sweep]\nN = [16]\nratios = [2]\n",
                                       ("[study]\n", '[study]\nkind = "identities"\n')))
        self.acstudy("run", "bounds.toml", "--out", "bounds")
        for args, message in ((["none.json"], "none.json"), (["bounds/tiny.json"], "nothing in it vanishes"),
                              (["out/tiny.json", "--format", "html"], "is none of markdown"),
                              (["out/tiny.json", "--norm", "h1"], "is none of max")):
            with self.subTest(args=args):
                done = self.acstudy("table", *args)
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertIn(message, done.stderr)


if __name__ == "__main__":
    unittest.main()
