"""Figures and table of studies that step in several ways, from synthetic result files."""

import math
import unittest

import numpy as np

from tests.result_files import ReportTest, of_study, series, write

from kinds import registry, stepping
from reading import results


def ways(**changes):
    """Three ways to step: one within the bound, one that blows up in its finest runs, one implicit."""
    nan = math.nan
    lost = dict(stepping="forward-euler, step h/4", integrator="forward-euler", verdict="unstable", expected="unstable",
                error_linf=np.array([0.1, nan, nan, nan]), bound_largest=np.array([1.0, 40.0, 80.0, 160.0]),
                bound_first_step=np.array([0, 31, 62, 124]), bound_first_time=np.array([nan, 1.1, 1.1, 1.1]),
                bound_first_place=np.array([nan, 3.1, 3.1, 3.14]), last_step=np.array([0, 99, 199, 399]),
                last_time=np.array([nan, 2.5, 2.25, 2.125]), last_place=np.array([nan, 3.2, 3.2, 3.1875]),
                last_particle=np.array([-1, 1, 2, 3]))
    return [series(stepping="forward-euler, step 0.9 cfl", expected="stable", bound_largest=np.full(4, 0.9), **changes),
            series(**(lost | changes)),
            series(stepping="sdirk2, step h/2", integrator="sdirk2", expected="stable", **changes)]


class SteppingFigures(ReportTest):
    def study(self, *all_series):
        return results.read_study(write(self.folder, "stiff", *all_series))

    def test_a_panel_per_path_and_scheme_and_a_curve_per_way(self):
        study = self.study(*ways(), *ways(path="delta = h^2"), *ways(model=2, kernel="cubic-spline", mu=1.5))
        self.assertTrue(study.steps_in_several_ways)
        drawing, = stepping.drawings(study, {})
        panels = drawing.figure.axes
        self.assertEqual(len(panels), 3)
        for panel in panels:
            curves = [line for line in panel.lines if line.get_marker() not in ("x", "|") and len(line.get_xdata())]
            self.assertEqual(len(curves), 3)
            crosses = [line for line in panel.lines if line.get_marker() == "x" and len(line.get_xdata())]
            self.assertEqual([len(line.get_xdata()) for line in crosses], [3])

    def test_a_way_of_which_every_run_blows_up_is_named(self):
        lost = ways()
        lost[1]["error_linf"] = np.full(4, math.nan)
        drawing, = stepping.drawings(self.study(*lost), {})
        texts = [text.get_text() for legend in drawing.figure.legends for text in legend.get_texts()]
        self.assertEqual(texts, ["forward-euler, step 0.9 cfl", "forward-euler, step h/4: blows up", "sdirk2, step h/2"])

    def test_the_table_says_what_each_way_came_to(self):
        table = stepping.table(self.study(*ways())).__html__()
        rows = table.split("<tr")[2:]
        self.assertEqual(len(rows), 3)
        self.assertIn("0.9", rows[0])
        self.assertIn(">stable<", rows[0])
        for words in ("unstable", "160", "step 124, <var>t</var> = 1.1, <var>x</var> = 3.14",
                      "step 399 of <var>N</var> = 1280, <var>t</var> = 2.12, <var>x</var> = 3.188"):
            self.assertIn(words, rows[1])
        self.assertNotIn("step 124", rows[0] + rows[2])

    def test_adaptive_steps_are_told_with_those_that_were_rejected(self):
        write(self.folder, "stiff", *ways(), series(
            stepping="sdirk3, adaptive to 1e-4", step_text="adaptive to 1e-4", integrator="sdirk3", expected="stable",
            tolerance=np.full(4, 1e-4), rejected=np.array([3, 5, 7, 11]), steps=np.array([31, 32, 33, 34])))
        self.assertEqual(self.run_report(self.folder)[0], 0)
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        self.assertIn("sdirk3, step adaptive to 1e-4", page)
        for count in ("+ 3 rejected", "+ 5 rejected", "+ 7 rejected", "+ 11 rejected"):
            self.assertIn(count, page)
        self.assertEqual(page.count("rejected"), 5)     # the finest twice: in the table of all ways, too

    def test_they_stay_out_of_the_figure_of_all_run_times(self):
        several, plain = self.study(*ways()), self.study(series())
        self.assertEqual(registry.with_run_times([several, plain]), [plain])

    def test_the_page_has_table_figure_and_every_series(self):
        write(self.folder, "stiff", *ways())
        code, _, err = self.run_report(self.folder)
        self.assertEqual((code, err), (0, ""))
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        for words in ("Stability and stiff scenes", 'id="stiff.figure"', "beyond it from", "Every series", "Stiff scenes",
                      "negative controls: 1 of 1 fail"):
            self.assertIn(words, page)

    def test_a_start_that_is_not_uniform_is_named(self):
        write(self.folder, "clustered", series(start="clustered(0.25)"))
        write(self.folder, "plain", series())
        self.assertEqual(self.run_report(self.folder)[0], 0)
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        self.assertEqual(of_study(page, "clustered").count(", start clustered(0.25)"), 1)
        self.assertNotIn(", start ", of_study(page, "plain"))

    def test_files_without_these_columns_are_read(self):
        study = self.study(series())
        self.assertFalse(study.steps_in_several_ways)
        self.assertTrue(np.isnan(study.findings[0].series.cases.bound_largest).all())


if __name__ == "__main__":
    unittest.main()
