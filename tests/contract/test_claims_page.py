"""Claim by claim, and findings in the page: every statement in its place, nothing that departs hidden."""

import json
import math
import re
import subprocess
import sys
import unittest

import h5py
import numpy as np

from tests.result_files import ROOT, ReportTest, finding, of_study, series, write

from pages import claims, page
from reading import ledger, results


def read(folder, name="ledger", *all_series, **more):
    return results.read_study(write(folder, name, *all_series, **more))


class Reading(ReportTest):
    def test_findings_are_read_with_their_points(self):
        one = finding(N=(0, 80), value=[1.0, math.nan], lower=-2.0, test="bounds", labels="space\ntime\n",
                      also_expected="floor below")
        for fixed_length in (False, True):
            study = read(self.folder, kind="pollution", findings=[one], fixed_length=fixed_length, scene=False)
            found = study.findings[0]
            self.assertEqual((study.kind, study.scene, study.evidence), ("pollution", None, ()))
            self.assertEqual(found.points.label, ("space", "time"))
            self.assertEqual(found.also_expected, ("floor", "below"))
            np.testing.assert_array_equal(found.points.lower, [-2.0, -2.0])
            self.assertTrue(math.isnan(found.points.value[1]) and math.isinf(found.points.upper[0]))

    def test_a_file_without_kind_and_findings_is_a_convergence_study(self):
        path = write(self.folder, "old", series())
        with h5py.File(path) as file:
            self.assertNotIn("kind", file.attrs)
            self.assertNotIn("findings", file)
        study = results.read_study(path)
        self.assertEqual((study.kind, len(study.findings), study.evidence), ("convergence", 1, ()))
        self.assertEqual(study.findings[0].series.path, "delta = 4h")

    def test_a_damaged_finding_is_refused(self):
        lacking, ragged, mislabeled = finding(), finding(value=[1.0, 2.0]), finding(labels="one\n")
        del lacking["promised"]
        for name, one, said in (("lacking", lacking, "no attribute promised"), ("ragged", ragged, "shape (2,)"),
                                ("mislabeled", mislabeled, "1 labels, but 4 points")):
            path = write(self.folder, name, kind="consistency", findings=[one])
            with self.subTest(name), self.assertRaisesRegex(results.ResultError, said.replace("(", r"\(").replace(
                    ")", r"\)")):
                results.read_study(path)


class Ledger(ReportTest):
    def test_values_that_theory_does_not_bound_are_in_the_study_but_no_evidence(self):
        record = finding(statement="Lemma 2.4, growth curve", test="bounds", promised="inconclusive",
                         expected="inconclusive", verdict="inconclusive")
        study = read(self.folder, kind="stability-map", findings=[record, finding(statement="Lemma 2.4, map")])
        of_paper, further = claims.statements([study])
        self.assertEqual([statement.name for statement in (*of_paper, *further)], ["Lemma 2.4, map"])
        self.assertEqual(len(ledger.entries(study)), 2)

    def test_statements_stand_in_the_order_of_the_paper_and_others_after_them(self):
        told = ("error budget", "Theorem 2.7 (2)", "Lemma 3.2, D", "Lemma 3.2, A", "(2.3)", "Theorem 2.7 (1), (2)",
                "Remark 2.1", "(3.4)", "Lemma 3.1", "Lemma 2.3")
        study = read(self.folder, kind="consistency", findings=[finding(statement=one) for one in told])
        of_paper, further = claims.statements([study])
        self.assertEqual([one.name for one in of_paper],
                         ["(2.3)", "Remark 2.1", "Lemma 2.3", "Theorem 2.7 (1), (2)", "Theorem 2.7 (2)", "Lemma 3.1",
                          "(3.4)", "Lemma 3.2, A", "Lemma 3.2, D"])
        self.assertEqual([one.name for one in further], ["error budget"])

    def test_series_and_findings_of_one_statement_share_a_row(self):
        settles = series(path="delta = 0.2", verdict="stagnates", expected="stagnates", theory_order=0.0,
                         theory_statement="Theorem 2.7 (2): the limit is another")
        studies = [read(self.folder, "fig2", series(), settles),
                   read(self.folder, "map", kind="map", findings=[finding(statement="Theorem 2.7 (2)")])]
        (statement,), _ = claims.statements(studies)
        self.assertEqual((len(statement.entries), len(statement.tested), len(statement.controls)), (3, 2, 1))
        self.assertEqual(statement.worst.verdict, "confirmed")

    def test_the_worst_is_what_departs_else_the_least_certain_else_the_nearest_to_its_bound(self):
        def worst(*found):
            (statement,), _ = claims.statements([read(self.folder, kind="stability", findings=found)])
            return statement.worst.subject

        near = finding(subject="near", test="bounds", value=[0.1, 0.9, 0.2, 0.3], upper=1.0)
        far = finding(subject="far", test="bounds", value=[0.1, 0.4, 0.2, 0.3], upper=1.0)
        unsure = finding(subject="unsure", verdict="pre-asymptotic")
        departing = finding(subject="departing", test="bounds", value=[2.0] * 4, upper=1.0, verdict="violated",
                            as_expected=0, alarm=1)
        control = finding(subject="control", test="bounds", value=[9.0] * 4, upper=1.0, verdict="violated",
                          promised="violated", expected="violated")
        self.assertEqual(worst(far, near, control), "near")
        self.assertEqual(worst(unsure, near, control), "unsure")
        self.assertEqual(worst(far, departing, unsure, control), "departing")

    def test_a_value_that_is_no_number_is_the_worst(self):
        points = read(self.folder, kind="stability", findings=[
            finding(test="bounds", value=[0.1, math.nan, 0.9, 0.2], upper=1.0)]).findings[0].points
        self.assertEqual(ledger.closest(points), (1, -math.inf))

    def test_wrong_schemes_and_synthetic_series_are_no_evidence(self):
        studies = [read(self.folder, kind, kind=kind, findings=[finding()]) for kind in ("controls", "corpus")]
        self.assertEqual(claims.statements(studies), ([], []))


    def test_a_value_beside_a_round_bound_shows_by_how_much_it_differs(self):
        def measured(value, upper):
            return ledger.measured(read(self.folder, kind="stability", findings=[
                finding(N=(80,), test="bounds", value=[value], upper=upper)]).findings[0])

        ulp = 2.0**-52
        self.assertEqual(measured(1 + ulp, 1 + 10 * ulp), "1 + 2.2e−16 ≤ 1 + 2.2e−15")
        self.assertEqual(measured(1 - ulp, 1 + 10 * ulp), "1 − 2.2e−16 ≤ 1 + 2.2e−15")
        self.assertEqual(measured(1 + 10 * ulp, 1 + ulp), "1 + 2.2e−15 > 1 + 2.2e−16")
        self.assertEqual(measured(1.0, 1 + ulp), "1 ≤ 1 + 2.2e−16")
        self.assertEqual(measured(1.0, 1.0), "1 ≤ 1")
        self.assertEqual(measured(0.0, 0.0), "0 ≤ 0")
        self.assertEqual(measured(0.5, 1.0), "0.5 ≤ 1")
        # Three digits, or as many more as tell a value from its bound.
        self.assertEqual(measured(0.5457791, 1.065812e-11), "0.546 > 1.07e−11")
        self.assertEqual(measured(1.00237, 1.00412), "1.002 ≤ 1.004")
        self.assertEqual(measured(1.000021, 1.0001), "1 ≤ 1.0001")


class Extremes(ReportTest):
    """The table of a study of kind "extremes": a row per expectation, all findings below it."""

    ROW = dict(statement="N = 3 to 9", claim="norms are <1>", test="bounds", check="uniform", upper=1.0)

    def table(self, *found):
        html = page.html([read(self.folder, kind="extremes", findings=found, scene=False)], {})
        table = html[html.index('aria-label="A study"'):]
        return table[:table.index("</table>")], html

    def test_a_row_has_the_worst_of_all_schemes_and_counts_its_controls(self):
        table, html = self.table(
            finding(subject="near", value=[0.1, 0.9, 0.2, 0.3], **self.ROW),
            finding(subject="far", value=[0.1, 0.4, 0.2, 0.3], **self.ROW),
            finding(subject="wrong", value=[2.0] * 4, verdict="violated", expected="violated", alarm=1, **self.ROW),
            finding(subject="other", statement="N = 3 to 9", claim="order 1", value=[0.8, 0.4, 0.2, 0.1]))
        self.assertEqual(table.count("<tr"), 3)
        self.assertEqual(table.count('<a href="#ledger.N---3-to-9">N = 3 to 9</a>'), 2)
        self.assertIn("norms are &lt;1&gt;", table)
        self.assertIn("0.9 ≤ 1<br>", table)
        self.assertNotIn("0.4 ≤ 1", table)
        self.assertIn("2 findings on 2 subjects", table)
        self.assertIn("<td>1 of 1 fail</td><td>all</td>", table)
        self.assertIn("0.1 at N = 1280", table)
        self.assertIn('<details id="ledger.N---3-to-9" class="findings"><summary>', html)
        for subject in ("near", "far", "wrong", "other"):
            self.assertIn(f'<th scope="row">{subject}</th>', html)

    def test_a_row_that_departs_stands_out_and_is_unfolded(self):
        bad = finding(value=[2.0] * 4, verdict="violated", as_expected=0, alarm=1, **self.ROW)
        caught = finding(subject="missed", value=[0.5] * 4, expected="violated", as_expected=0, **self.ROW)
        table, html = self.table(bad, caught)
        self.assertIn('<tr class="departs">', table)
        self.assertIn('<span class="badge bad">violated</span>', table)
        self.assertIn("<td>0 of 1 fail</td><td><strong>2 of 2 not</strong></td>", table)
        self.assertIn('<details id="ledger.N---3-to-9" class="findings" open>', html)


class Pages(ReportTest):
    def html(self, *studies):
        return page.html(studies, {})

    def test_a_departure_stands_out(self):
        bad = finding(verdict="below", as_expected=0, alarm=1, reason="pairwise orders <0.5>", observed_order=0.5,
                      observed_low=0.4, observed_high=0.6)
        study = read(self.folder, kind="consistency", findings=[finding(check="moved, delta = 4h"), bad])
        html = self.html(study)
        self.assertIn("1 of 2 findings not as expected", html)
        self.assertIn("<strong>1 of 2 not</strong>", html)
        self.assertIn('<tr class="departs"><th scope="row" class="said">Lemma 2.5</th>', html)
        self.assertIn('<span class="badge bad">below</span>', html)
        self.assertIn("pairwise orders &lt;0.5&gt;", html)
        self.assertIn("lowest order 0.50 [0.40, 0.60]", html)
        self.assertIn("highest order 0.98", html)
        self.assertLess(html.index("pairwise orders &lt;0.5&gt;"), html.index('class="verdicts"'))   # in full, on top
        study = of_study(html, "ledger")
        self.assertLess(study.index("pairwise orders &lt;0.5&gt;"), study.index("<summary>Every finding"))

    def test_a_statement_that_is_refuted_does_not_pass_for_one_that_holds(self):
        refuted = finding(verdict="violated", promised="holds", expected="violated", alarm=1, test="bounds",
                          value=[2] * 4, upper=1.0, check="uneven")
        html = self.html(read(self.folder, kind="stability", findings=[finding(verdict="holds"), refuted]))
        self.assertIn("All 2 findings are as expected", html)
        self.assertIn('<span class="badge near">not so as printed</span>', html)
        self.assertIn("1 of 2 show that it does not hold as printed", html)
        self.assertNotIn("negative controls", html)
        departing = refuted | dict(verdict="holds", as_expected=0, alarm=0)
        html = self.html(read(self.folder, kind="stability", findings=[finding(verdict="holds"), departing]))
        self.assertNotIn('<span class="badge near">not so as printed</span>', html)
        self.assertIn('class="departs"', html)

    def test_a_bound_that_is_not_attained_is_no_failure_of_its_statement(self):
        unsharp = finding(verdict="stagnates", promised="diverges", expected="stagnates", alarm=1, check="delta -> 0")
        html = self.html(read(self.folder, kind="consistency", findings=[finding(verdict="holds"), unsharp]))
        self.assertIn("1 finding more: a bound is not attained", html)
        self.assertNotIn('<span class="badge bad">', html)

    def test_a_negative_control_is_no_alarm_unless_it_holds(self):
        caught = finding(verdict="violated", promised="violated", expected="violated", test="bounds",
                         value=[2] * 4, upper=1.0)
        missed = caught | dict(verdict="holds", as_expected=0, alarm=1, check="moved")
        html = self.html(read(self.folder, kind="stability", findings=[finding(), caught]))
        self.assertIn("All 2 findings are as expected", html)
        self.assertIn("negative controls: 1 of 1 fail or settle as they must", html)
        self.assertIn('<span class="badge control">violated</span>', html)
        self.assertNotIn('class="departs"', html)
        html = self.html(read(self.folder, kind="stability", findings=[finding(), caught, missed]))
        self.assertIn("negative controls: 1 of 2 fail or settle as they must", html)
        self.assertIn('<span class="badge bad">holds</span>', html)

    def test_a_statement_links_to_figures_and_studies_that_exist(self):
        write(self.folder, "fig2", series())
        write(self.folder, "consistency", kind="consistency", findings=[finding()])
        self.assertEqual(self.run_report(self.folder)[0], 0)
        html = (self.folder / "index.html").read_text(encoding="utf-8")
        for place in ("consistency.lemma-2-5.figure", "fig2.figure", "consistency", "fig2"):
            self.assertIn(f'<a href="#{place}"', html)
            self.assertEqual(html.count(f' id="{place}"'), 1)
        self.assertIn('data-find="Lemma 2.5">consistency: 1 finding</a>', html)
        self.assertIn("All 1 series and 1 findings are as expected", html)

    def test_no_two_places_have_one_name(self):
        for name in ("stability", "figures", "main", "explorer"):
            write(self.folder, name, kind="stability", findings=[finding(test="bounds", upper=1.0)])
        self.assertEqual(self.run_report(self.folder)[0], 0)
        places = re.findall(r' id="([^"]+)"', (self.folder / "index.html").read_text(encoding="utf-8"))
        self.assertEqual(len(places), len(set(places)))

    def test_a_wide_interval_says_what_it_is_worth(self):
        wide = finding(test="rate", verdict="holds", promised="holds", expected="holds", observed_order=0.91,
                       observed_low=0.09, observed_high=1.71)
        narrow = wide | dict(observed_low=0.8, observed_high=1.1, check="moved")
        html = self.html(read(self.folder, kind="consistency", findings=[wide]))
        self.assertIn("such an interval alone would say little", html)
        html = self.html(read(self.folder, kind="consistency", findings=[narrow]))
        self.assertNotIn("such an interval alone would say little", html)

    def test_synthetic_series_are_listed_with_right_and_given_verdict(self):
        right = finding(statement="corpus", subject="drift", claim="it <drifts>", verdict="below", expected="below",
                        promised="below", also_expected="inconclusive")
        wrong = right | dict(subject="noise", verdict="confirmed", as_expected=0)
        study = read(self.folder, "corpus", kind="corpus", findings=[right, wrong])
        index = page.html([study], {})
        self.assertIn("<td>below or inconclusive</td>", index)
        self.assertIn("it &lt;drifts&gt;", index)
        self.assertEqual(of_study(index, "corpus").count('<tr class="departs"><th scope="row">noise</th>'), 1)
        self.assertIn("1 of 2 findings not as expected; 1 of 2 synthetic series of known order get the right verdict", index)


class Table(ReportTest):
    def test_the_table_of_theorems_passes_over_studies_that_are_judged_by_findings(self):
        for kind in ("corpus", "map"):
            (self.folder / f"{kind}.json").write_text(json.dumps({"study": kind, "kind": kind, "findings": []}))
        done = subprocess.run([sys.executable, "scripts/claims.py", str(self.folder)], cwd=ROOT, text=True,
                              capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stderr, done.stdout.count("\n")), (0, "", 2))
        # A series of which nothing but stability is asked has no row, but departs all the same.
        stiff = {"theory": {"statement": "Theorem 2.7 (2)", "order": 1, "variable": "h"}, "kernel": "inverse",
                 "observed": {"order": None}, "verdict": "unstable", "expected": "stable", "as_expected": False}
        for as_expected, code in ((True, 0), (False, 1)):
            (self.folder / "stiff.json").write_text(
                json.dumps({"study": "stiff", "series": [stiff | {"as_expected": as_expected}]}))
            done = subprocess.run([sys.executable, "scripts/claims.py", str(self.folder)], cwd=ROOT, text=True,
                                  capture_output=True, check=False)
            self.assertEqual((done.returncode, done.stderr, done.stdout.count("\n")), (code, "", 2))
        (self.folder / "fig1.json").write_text(json.dumps({"study": "fig1", "findings": []}))
        done = subprocess.run([sys.executable, "scripts/claims.py", str(self.folder)], cwd=ROOT, text=True,
                              capture_output=True, check=False)
        self.assertEqual(done.returncode, 2)


if __name__ == "__main__":
    unittest.main()
