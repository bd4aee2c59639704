"""The figures of findings: they show every finding, mark what departs, and draw what cannot be drawn nowhere."""

import math
import unittest
from xml.etree import ElementTree

from matplotlib.colors import to_hex
import numpy as np

from tests.result_files import ReportTest, finding, series, write

from kinds import controls, coverage, error_map, identities, registry, stability
from drawing import look
from reading import results

NOWHERE = dict(value=[math.nan, math.inf, 0.0, -1.0])


class FigureTest(ReportTest):
    def study(self, kind, *found, name=None, all_series=(), **more):
        return results.read_study(write(self.folder, name or kind, *all_series, kind=kind, findings=found, **more))

    def texts(self, kind, *found, **more):
        """The SVG of every drawing of a study, by its stem."""
        drawings = registry.drawings(self.study(kind, *found, **more), {})
        svgs = {one.stem: look.image(one.figure, one.title, "svg").decode() for one in drawings}
        for text in svgs.values():
            ElementTree.fromstring(text)
        return svgs


class Operators(FigureTest):
    def test_consistency_has_a_figure_per_statement_with_its_arrangements_and_schemes(self):
        found = [finding(statement=statement, check=f"{arrangement}, delta = 4h", subject=subject)
                 for statement in ("Lemma 2.5", "Lemma 3.4, A") for arrangement in ("uniform", "jittered")
                 for subject in ("scheme one", "scheme two")]
        texts = self.texts("consistency", *found)
        self.assertEqual(list(texts), ["consistency.lemma-2-5", "consistency.lemma-3-4-a"])
        for text in texts.values():
            for word in ("uniform", "jittered", "scheme one", "scheme two", "order 1"):
                self.assertIn(f">{word}<", text)

    def test_extremes_have_a_figure_where_something_has_an_order(self):
        found = [finding(statement="T = 0", test="bounds", value=[0.0] * 4, upper=0.0),
                 finding(statement="mass drift", subject="Model I, inverse", check="jittered, c = 1"),
                 finding(statement="mass drift", subject="Model I, local divergence, inverse"),
                 finding(statement="hat", subject="Model I, inverse", check="uniform, delta = h"),
                 finding(statement="hat", subject="Model I, inverse", check="jittered, delta = h"),
                 finding(statement="hat", subject="a wrong scheme", check="jittered, delta = h", verdict="below",
                         expected="below", alarm=1)]
        texts = self.texts("extremes", *found)
        self.assertEqual(list(texts), ["extremes.mass-drift-jittered-particles", "extremes.mass-drift-moving-particles",
                                       "extremes.hat"])
        for word in ("uniform", "jittered", "Model I, inverse", "order 1"):
            self.assertIn(f">{word}<", texts["extremes.hat"])
        self.assertNotIn("a wrong scheme", texts["extremes.hat"])

    def test_what_cannot_be_drawn_leaves_no_figure_and_no_crash(self):
        for kind in ("consistency", "identities"):
            self.assertEqual(self.texts(kind, finding(**NOWHERE)), {})
        self.assertEqual(self.texts("stability", finding(test="bounds")), {})
        self.assertEqual(len(self.texts("stability", finding(test="bounds", upper=1.01, **NOWHERE))), 1)
        self.assertEqual(len(self.texts("identities", finding(test="bounds", upper=1.0, **NOWHERE))), 1)
        for kind in (*registry.KINDS, "corpus", "a kind of tomorrow"):
            self.assertEqual(self.texts(kind, name="none"), {})

    def test_digits_have_one_bound_and_pale_controls(self):
        of = dict(test="bounds", variable_name="delta/h", quantity="max |value / exact - 1|", upper=1e-13)
        found = [finding(check=check, statement=statement, subject=subject, **more, **of)
                 for check in ("weights of Model I", "N_j of Model II") for subject in ("kernel one", "kernel two")
                 for statement, more in (("round-off", {}), ("round-off, not factored", dict(expected="violated")))]
        gaps = finding(statement="round-off", check="gaps, N = 10", **{**of, "variable_name": "T"})
        text, = self.texts("digits", *found, gaps).values()
        self.assertEqual(text.count(">bound<"), 2)
        for word in ("weights of Model I", "N_j of Model II", "kernel one", "kernel two"):
            self.assertIn(f">{word}<", text)
        self.assertNotIn("gaps", text)
        self.assertIn("opacity: 0.35", text)

    def test_departing_curves_are_marked(self):
        quiet, = self.texts("consistency", finding()).values()
        loud, = self.texts("consistency", finding(as_expected=0, verdict="below")).values()
        mark = to_hex(look.DEPARTING)
        self.assertIn(mark, loud)
        self.assertNotIn(mark, quiet)

    def test_deviations_are_relative_to_what_is_allowed(self):
        def relative(**more):
            return identities._relative(self.study("identities", finding(test="bounds", **more)).findings[0])

        self.assertEqual(relative(N=(1, 2), value=[0.5, -3.0], lower=-4.0, upper=2.0), (2 / 3, 2.0))
        self.assertEqual(relative(N=(1, 2), value=[0.5, 0.2], upper=2.0), (0.25, 0.5))
        self.assertEqual(relative(N=(1,), value=[math.nan], upper=2.0)[0], math.inf)
        self.assertIsNone(relative(N=(1,), value=[0.5], lower=0.0))

    def test_growth_is_relative_to_its_bound_and_the_worst_of_all_particle_numbers(self):
        one = self.study("stability", finding(test="bounds", value=[1.01, 1.04, 1.0, 1.03], upper=1.02,
                                              variable=np.array([1.0, 1.0, 0.1, 10.0]))).findings[0]
        x, growth = stability._growth(one)
        np.testing.assert_array_equal(x, [0.1, 1.0, 10.0])
        np.testing.assert_allclose(growth, [0.0, 2.0, 1.5])


class DetectionMatrix(FigureTest):
    def test_true_schemes_come_first_and_alarms_are_counted(self):
        alarm = dict(verdict="stagnates", expected="stagnates", alarm=1)
        found = [finding(subject=subject, check=check) for subject in ("downwind", "true")
                 for check in ("delta = 4h", "step norm")]
        found[0] |= alarm
        study = self.study("controls", *found)
        self.assertEqual(controls.rows_and_columns(study.findings),
                         (["true", "downwind"], ["delta = 4h", "step norm"]))
        text, = self.texts("controls", *found).values()
        self.assertEqual((text.count(">stagnates<"), text.count(">1<"), text.count(">0<")), (1, 1, 1))
        self.assertNotIn(">not examined<", text)

    def test_unexpected_and_missing_alarms_are_outlined(self):
        def outlines(*found):
            text, = self.texts("controls", *found).values()
            return text.count(f"stroke: {to_hex(look.DEPARTING)}") - 1      # one is in the legend

        alarm = finding(verdict="below", expected="below", alarm=1)
        other = dict(check="step norm")
        self.assertEqual(outlines(alarm, finding(**other)), 0)
        self.assertEqual(outlines(alarm, finding(verdict="below", alarm=1, as_expected=0, **other)), 1)
        self.assertEqual(outlines(alarm, finding(expected="below", as_expected=0, **other)), 1)


class Maps(FigureTest):
    def all_series(self):
        N, made = np.array((57, 113, 226)), []
        for source in ("local", "nonlocal"):
            for delta in (0.001, 0.01, 0.1):
                h = 2 * math.pi / N
                error = h + (delta if source == "local" else 0.0)
                made.append(series(N=N, error_linf=error, source=source, delta=np.full(3, delta),
                                   path=f"delta = {delta}"))
        return made

    def test_a_map_has_every_case_in_its_place(self):
        study = self.study("map", all_series=self.all_series())
        planes = error_map.error_planes(study.evidence)
        self.assertEqual([source for _, source in planes], ["local", "nonlocal"])
        for (_, source), (h, delta, error) in planes.items():
            self.assertTrue(np.all(np.diff(h) > 0) and np.all(np.diff(delta) > 0))
            expected = h[None, :] + (delta[:, None] if source == "local" else 0 * delta[:, None])
            np.testing.assert_allclose(error, expected, rtol=1e-6)

    def test_a_map_shows_fit_and_paths_and_is_no_convergence_study(self):
        fit = finding(test="surface", subject="Model I, local divergence, inverse", check="local source, delta <= 0.1",
                      coordinates=dict(source="local"),
                      surface_p=0.98, surface_p_low=0.9, surface_p_high=1.06, surface_q=1.02, surface_q_low=1.0,
                      surface_q_high=1.04, surface_bic=-700.0, surface_bic_sum=-400.0)
        texts = self.texts("map", fit, all_series=self.all_series())
        self.assertEqual(list(texts), ["map", "map.cuts"])
        self.assertIn("0.98 [0.90, 1.06]", texts["map"])
        self.assertIn("1.02 [1.00, 1.04]", texts["map"])
        study = self.study("map", fit, all_series=self.all_series())
        self.assertEqual(registry.with_run_times([study]), [])
        caption = error_map.drawings(study, {})[0].caption
        self.assertEqual(error_map.drawings(study, {})[0].says,
                         "Over the whole plane the error has the orders p = 0.98 in h and q = 1.02 in δ.")
        self.assertIn("error = (a^m + b^m)^(1/m)", caption)
        self.assertIn("plain sum a + b is larger by 300.", caption)

    def test_cases_that_failed_leave_holes(self):
        broken = self.all_series()
        broken[0]["error_linf"] = np.array([math.nan, math.inf, 0.01])
        self.assertEqual(len(self.texts("map", all_series=broken)), 2)


class Measurement(FigureTest):
    def test_shares_of_an_error_are_drawn_and_a_large_time_share_is_hatched(self):
        def text(time):
            return self.texts("pollution", finding(
                N=(640,) * 3, test="bounds", check="fig1, N = 640", labels="time\nsource\nspace\n",
                value=[time, 1e-9, 0.9], upper=np.array([math.inf, 0.01, math.inf])), scene=False)["pollution"]

        for word in ("fig1", "space", "time", "source"):
            self.assertIn(f">{word}<", text(0.2))
        self.assertNotIn("time &gt; half", text(0.2))
        self.assertIn("time &gt; half", text(0.6))

    def test_coverage_has_binomial_intervals(self):
        share, trials = np.array([0.95, 1.0, 0.0]), np.array([1000, 50, 20])
        for bound, at_edge in zip(coverage.wilson(share, trials), (2, 1)):
            # Wilson's bounds are the true shares p from which the observed one is 1.96 standard deviations away.
            np.testing.assert_allclose((share - bound) ** 2, 1.959964 ** 2 * bound * (1 - bound) / trials, atol=1e-12)
            self.assertAlmostEqual(bound[at_edge], share[at_edge])
        text, = self.texts("coverage", finding(
            N=(1000, 1000), test="bounds", lower=0.93, upper=0.97, value=[0.95, 0.94], variable=np.array([4.0, 5.0]),
            subject="reported interval", check="power law")).values()
        self.assertIn(">reported interval, power law<", text)


if __name__ == "__main__":
    unittest.main()
