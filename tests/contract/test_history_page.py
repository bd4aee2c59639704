"""Several runs side by side on a page, a column each: what changed comes first, and nothing that changed is hidden."""

import math
import re
import unittest

import h5py
import numpy as np

from tests.browser import BrowserTest, axe, needs_browser
from tests.result_files import ReportTest, finding, series, write

from pages import history as page
from reading import history, results


def other_path(path, **changes):
    return series(path=path, **changes)


class RunsTest(ReportTest):
    def run_of(self, name, *all_series, study="one", **more):
        """A run with one study."""
        folder = self.folder / name
        folder.mkdir(exist_ok=True)
        return page.Run(name, (results.read_study(write(folder, study, *all_series, **more)),))


class History(RunsTest):
    def changes(self, *runs):
        return [line.change for line in history.lines([run.studies for run in runs])]

    def test_what_has_become_of_a_finding(self):
        good, bad = series(), series(verdict="below", as_expected=0)
        near = series(verdict="pre-asymptotic")
        bit = series(error_linf=np.nextafter(series()["error_linf"], [0, 0, 1, 0]))
        loosened = series(verdict="below", expected="below")
        for found, change in (((good, good), "same"), ((good, bad), "worsened"), ((bad, good), "improved"),
                              ((good, near), "verdict"), ((good, bit), "numbers"), ((bad, bad), "same"),
                              ((good, bad, good), "improved"), ((bad, good, bad), "worsened"), ((good, loosened), "worsened"),
                              ((good, series(expected="stable", as_expected=1)), "same"),
                              ((good, series(error_l2=series()["error_l2"] * 2)), "numbers"),
                              ((good, series(work_pairs=series()["work_pairs"] + 1)), "numbers"),
                              ((good, series(seconds=series()["seconds"] * 2)), "same"),
                              ((good, series(theory_statement="Theorem 9.9")), "same"),
                              ((good, series(N=(160, 320, 640))), "numbers")):
            with self.subTest(change, found=[one["verdict"] for one in found]):
                runs = [self.run_of(f"run{i}", one) for i, one in enumerate(found)]
                self.assertEqual(self.changes(*runs), [change])

    def test_findings_without_series_are_known_by_their_statement(self):
        one, other = finding(), finding(statement="Lemma 2.4")
        runs = [self.run_of("a", kind="consistency", findings=[one, other]),
                self.run_of("b", kind="consistency", findings=[other, dict(one, verdict="below", as_expected=0)])]
        lines = history.lines([run.studies for run in runs])
        self.assertEqual([line.change for line in lines], ["worsened", "same"])

    def test_a_study_that_a_run_has_not_is_no_missing_finding(self):
        runs = [self.run_of("a", series(), other_path("delta = 2h")), self.run_of("b", series()),
                self.run_of("c", series(), study="two")]
        self.assertEqual(self.changes(*runs), ["same", "missing", "same"])

    def test_ratios_are_of_the_last_run_to_the_first(self):
        runs = [self.run_of("a", series()), self.run_of("b", series(error_linf=series()["error_linf"] * [1, 2, 3, 1.5],
                                                                    work_pairs=series()["work_pairs"] * 2))]
        line, = history.lines([run.studies for run in runs])
        np.testing.assert_allclose(line.errors, (1, 3))
        self.assertEqual((line.pairs, line.seconds), (2.0, 1.0))
        runs[1] = self.run_of("b", series(N=(10, 20, 40)))
        line, = history.lines([run.studies for run in runs])
        self.assertTrue(math.isnan(line.errors[0]) and math.isnan(line.pairs))

    def test_the_page_has_a_column_for_each_run_and_what_changed_first(self):
        runs = [self.run_of("a<b", series(), other_path("delta = 2h"), other_path("delta = h")),
                self.run_of("last", series(), other_path("delta = 2h", error_linf=1.3 * series()["h"] * 1.5),
                            other_path("delta = h", verdict="below", as_expected=0))]
        text = page.html(runs)
        self.assertIn("Of 3 verdicts: 1 worsened, 1 other numbers, 1 the same.", text)
        self.assertNotIn("a<b", text)
        heads = re.findall(r"<thead><tr>(.*?)</tr></thead>", text)
        for head in heads[:3]:
            self.assertRegex(head, r">change<.*>a&lt;b<.*>last<.*>errors, last to first<")
        rows = re.findall(r"<tr.*?</tr>", text.partition('id="q.verdicts"')[2].partition("</section>")[0])
        self.assertEqual(len(rows), 2)
        self.assertTrue(rows[1].startswith('<tr class="departs">'))
        self.assertIn("expected confirmed", rows[1])
        self.assertIn(">1.5<", text.partition('id="q.numbers"')[2].partition("</section>")[0])
        self.assertEqual(len(re.findall("<tbody>.*?</tbody>", text.partition('id="q.all"')[2], re.DOTALL)), 2)

    def test_what_is_the_same_is_said_to_be(self):
        text = page.html([self.run_of("a", series()), self.run_of("b", series())])
        self.assertIn("Nothing has changed in 1 verdict and their numbers.", text)
        self.assertNotIn('id="q.verdicts"', text)
        self.assertNotIn("deterministic", text)

    def test_where_runs_are_from(self):
        def from_compiler(name):
            run = self.run_of(name, series(error_linf=series()["error_linf"] * (2 if name == "b" else 1)))
            with h5py.File(run.studies[0].file, "r+") as file:
                file["provenance"].attrs["compiler"] = f"compiler {name}"
            return page.Run(name, (results.read_study(run.studies[0].file),))

        text = page.html([from_compiler("a"), from_compiler("b")])
        self.assertRegex(text, r"<strong>compiler</strong>.*differs.*compiler a.*compiler b")
        self.assertIn("numbers differ because of compiler, or of the study files", text)
        same = [self.run_of("a", series()), self.run_of("b", series(observed_order=0.98))]
        self.assertIn("Nothing that decides a run differs", page.html(same))

    def test_the_program_writes_the_page_and_nothing_else(self):
        for name in ("old", "new"):
            self.run_of(name, series())
        old, new = self.folder / "old", self.folder / "new"
        self.assertEqual(self.run_report(new, "--against", old, "--against", old), (0, f"{new / 'history.html'}\n", ""))
        self.assertEqual(sorted(file.name for file in new.iterdir() if not file.name.startswith(".")),
                         ["history.html", "one.h5"])
        self.assertEqual([file.name for file in old.iterdir()], ["one.h5"])
        self.run_report(new)
        front = new / "index.html"
        self.assertEqual(front.read_text(encoding="utf-8").count('href="history.html"'), 1, "drawn after it")
        self.assertEqual(self.run_report(old)[0], 0)
        self.assertNotIn("history.html", (old / "index.html").read_text(encoding="utf-8"))
        for _ in range(2):
            self.run_report(old, "--against", new)
            self.assertEqual((old / "index.html").read_text(encoding="utf-8").count('href="history.html"'), 1)
        for arguments, said in (((new, "--against", self.folder / "none"), "no such folder"),
                                ((new, "--against", old, "--folder"), "leave out --figures and --folder"),
                                ((new, "--against", self.folder), "no result file (*.h5) in it")):
            with self.subTest(said):
                code, out, err = self.run_report(*arguments)
                self.assertEqual((code, out), (2, ""))
                self.assertIn(said, err)


@needs_browser
class InABrowser(BrowserTest, RunsTest):
    def setUp(self):
        super().setUp()
        paths = ["delta = 4h", "delta = 2h", "delta = h", "delta = h^2", "delta = sqrt(h)", "delta = 8h", "delta = 9h"]
        runs = [self.run_of("a", *map(other_path, paths), other_path("delta = 3h")),
                self.run_of("b", *(other_path(path, error_linf=1.3 * series()["h"] * (i + 1)) for i, path in enumerate(paths)),
                            other_path("delta = 3h", verdict="below", as_expected=0))]
        self.page = self.folder / "history.html"
        self.page.write_text(page.html(runs), encoding="utf-8")

    def test_it_opens_without_a_complaint_and_its_tables_are_sorted_and_filtered(self):
        self.open(self.page, "#&sort Numbers that changed=4 down&find Numbers that changed=fig")
        self.assertEqual(self.errors(), [])
        rows = "return [...document.querySelector(\"table[aria-label='Numbers that changed']\").tBodies[0].rows]"
        self.assertEqual(self.run_script(rows + ".filter(row => !row.hidden).length"), 0)
        self.open(self.page, "#&sort Numbers that changed=4 down")
        self.assertEqual(self.run_script(rows + ".map(row => row.cells[4].textContent)"), ["7", "6", "5", "4", "3", "2"])

    def test_it_fits_a_phone_and_everybody(self):
        text = axe()
        for media in (dict(), dict(prefers_color_scheme="dark"), dict(width=375)):
            with self.subTest(media):
                self.open(self.page, **media)
                width = media.get("width", 1300)
                self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), width)
                self.run_script("document.querySelectorAll('details').forEach((one) => { one.open = true; });")
                self.settle()
                self.run_script(text)
                found = self.browser.execute_async_script(
                    "const done = arguments[0]; axe.run(document, {resultTypes: ['violations']}).then(one => done("
                    "one.violations.filter(v => ['serious', 'critical'].includes(v.impact)).map(v => v.id)))")
                self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main()
