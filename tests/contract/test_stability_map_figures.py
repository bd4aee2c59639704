"""Figures and table of stability maps, from synthetic findings."""

import math
import re
import unittest
import warnings

from matplotlib.path import Path
import numpy as np

from tests.result_files import ReportTest, coordinates, finding, write

from drawing import hover, look
from reading import results
from kinds import registry
from kinds.stability_map import findings as stability_map_findings, maps, positivity as smallest_entries, table as sharp_limits

RATIOS, CFL = (0.5, 2.0, 8.0), (0.5, 1.0, 2.0, 4.0)


def stability(kind, N, **changes):
    """A finding "Lemma 2.4, <kind>" with N = 48 at every point."""
    values = dict(statement=f"Lemma 2.4, {kind}", subject="Model I, inverse", check="uniform, forward-euler",
                  test="bounds") | changes
    of_map = dict(lemma=values["statement"].partition(", ")[0], measure=stability_map_findings.MEASURES[kind])
    return finding(N=(48,) * N, coordinates=coordinates(values["check"]) | of_map, **values)


def on_grid(kind, values, ratios=RATIOS, cfl=CFL, **changes):
    """Values [ratio][CFL number] over the plane of both."""
    x, y = (np.ravel(axis) for axis in np.meshgrid(ratios, cfl, indexing="ij"))
    h = 2 * math.pi / 48
    return stability(kind, len(x), **(dict(value=np.ravel(values), variable=y, variable_name="CFL number",
                                           delta=x * h, h=np.full(len(x), h)) | changes))


def growth_map(values=None, *axes, **changes):
    if values is None:
        values = [[1.0, 1.0, 50.0, 1e300], [1.0, 1.0, 1.0, 2e7], [1.0] * 4]
    return on_grid("map", values, *axes, **changes)


def limit(kind="max norm", value=(1.0, 1.5, 6.0), lower=(1.0, 1.4, 4.0), ratios=RATIOS, **changes):
    return stability(f"sharp in the {kind}", len(ratios), value=value, lower=np.array(lower, dtype=float),
                     variable=np.array(ratios), variable_name="delta/h", **changes)


def curve(cfl=2, value=(1.0, 3.0, 9.0), check="uniform, forward-euler", **changes):
    return stability("growth curve", len(value), value=value, variable=np.arange(1.0, len(value) + 1),
                     variable_name="t", check=f"{check}, delta = 2.5h, CFL {cfl}", **changes)


def positivity(values=None, *axes, **changes):
    if values is None:
        values = [[0.0, 0.0, -1.0, -3.0], [0.0, 0.0, 0.0, -2.0], [0.0] * 4]
    return on_grid("positivity", values, *axes, **changes)


class StabilityMapTest(ReportTest):
    def study(self, *found, name="stable", **more):
        return results.read_study(write(self.folder, name, kind="stability-map", findings=found, **more))

    def drawings(self, *found, **more):
        """{part of the name: drawing}; every one of them is rendered, and no warning given."""
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.filterwarnings("ignore", module="pyparsing|matplotlib.*mathtext", category=DeprecationWarning)
            drawn = registry.drawings(self.study(*found, **more), {})
            for one in drawn:
                look.image(one.figure, one.title, "svg")
        return {one.stem.partition(".")[2]: one for one in drawn}


def legend(figure):
    return [text.get_text() for group in figure.legends for text in group.get_texts()]


def titles(figure):
    return [panel.get_title().replace("\n", " ") for panel in figure.axes if panel.get_title()]


def curves(panel, **style):
    """The lines of a panel with these properties, as arrays (x, y)."""
    return [np.array(line.get_xydata().T, dtype=float) for line in panel.lines
            if all(getattr(line, f"get_{key}")() == value for key, value in style.items())]


class Maps(StabilityMapTest):
    def test_values_fall_into_their_cells_and_bands(self):
        study = self.study(growth_map())
        ratios, cfl, values = stability_map_findings.plane(study.findings[0])
        np.testing.assert_allclose(ratios, RATIOS)
        np.testing.assert_allclose(cfl, CFL)
        self.assertEqual(values.shape, (4, 3))
        np.testing.assert_allclose(values[:, 0], [1.0, 1.0, 50.0, 1e300])
        bands = maps.band([1.0, 1 + 1e-9, 1.01, 3.5, 1e6 * 1.01, 1e300, math.inf, math.nan], 1.0)
        np.testing.assert_array_equal(bands, [0, 0, 1, 2, 8, 8, 8, math.nan])
        np.testing.assert_array_equal(maps.band([11.0, 13.0], 12.0), [0, 1])

    def test_cells_meet_half_way_and_a_single_one_has_a_width(self):
        np.testing.assert_allclose(maps.edges(np.array([1.0, 4.0])), [0.5, 2.0, 8.0])
        low, high = maps.edges(np.array([3.0]))
        self.assertTrue(low < 3.0 < high)

    def test_cells_beside_one_another_of_one_band_are_one_and_holes_are_none(self):
        def cells(values):
            panel = self.drawings(growth_map(values))[""].figure.axes[0]
            return [Path(cell).get_extents().bounds for patch in panel.patches for cell in patch.get_path().to_polygons()]

        self.assertEqual(len(cells([[1.0, 9.0, 9.0, 9.0]] * 3)), 4)
        self.assertEqual(len(cells([[1.0, 9.0, 9.0, 9.0], [1.0] * 4, [1.0] * 4])), 4 + 3)
        self.assertEqual(len(cells([[1.0, 9.0, 9.0, 9.0], [math.nan] * 4, [1.0] * 4])), 8)
        self.assertEqual(len(cells([[math.nan] * 4] * 3)), 0)

    def test_what_theory_allows_is_the_median_bound_of_the_shortest_steps(self):
        found = [growth_map(upper=np.array([at_shortest, 9.0, 1e300, math.inf] * 3))
                 for at_shortest in (11.5, 12.0, 13.0)]
        allowed = stability_map_findings.allowed_growth(self.study(*found).findings)
        self.assertEqual(allowed, 12.0)
        self.assertEqual(stability_map_findings.allowed_growth(self.study(growth_map()).findings), 1.0)

    def test_lemma_rows_and_both_limits_lie_on_top(self):
        one = self.drawings(growth_map(), limit(), limit("spectral radius", (1.1, 2.0, 8.0)))[""]
        panel = one.figure.axes[0]
        drawn = [list(y) for _, y in curves(panel)]
        for values in ([1.0, 1.0], [1.0, 1.5, 6.0], [1.0, 1.4, 4.0], [1.1, 2.0, 8.0]):
            self.assertIn(values, drawn)
        self.assertEqual(legend(one.figure), ["Lemma 2.4: CFL number 1", "sharp limit, max norm",
                                              "sufficient, by the rows of the scheme",
                                              "sharp limit, spectral radius"])
        self.assertEqual(one.statements, ("Lemma 2.4, map", "Lemma 2.4, sharp in the max norm",
                                          "Lemma 2.4, sharp in the spectral radius"))

    def test_limits_of_other_particles_integrators_and_schemes_stay_away(self):
        panel = self.drawings(growth_map(), limit(check="jittered, forward-euler"), limit(check="uniform, ssprk3"),
                              limit(subject="another"))[""].figure.axes[0]
        self.assertEqual([list(y) for _, y in curves(panel)], [[1.0, 1.0]])

    def test_no_stable_step_and_no_limit_are_said(self):
        def said(*found, **more):
            figure = self.drawings(growth_map(**more), *found)[""].figure
            return [text.get_text() for text in figure.axes[0].texts], legend(figure)

        texts, keys = said(limit(value=(1000.0, 0.0, 0.0)))
        self.assertEqual(texts, ["none"])
        self.assertIn("no CFL number is stable", keys)
        texts, keys = said(limit(value=(1000.0,) * 3, lower=(999.999,) * 3))
        self.assertEqual(texts, ["no limit up to 1000"])
        self.assertNotIn("no CFL number is stable", keys)

    def test_integrators_that_stay_within_what_is_allowed_are_named_and_not_drawn(self):
        one = self.drawings(growth_map(), growth_map([[1.0] * 4] * 3, check="uniform, backward-euler"))[""]
        self.assertEqual([panel.get_ylabel() for panel in one.figure.axes][:-1], ["forward-euler\nCFL number"])
        self.assertIn("keep to what is allowed everywhere: backward-euler.", one.caption)
        alone = self.drawings(growth_map([[1.0] * 4] * 3))[""]
        self.assertEqual(len(alone.figure.axes), 2)     # the map and its key
        self.assertNotIn("Not drawn", alone.caption)

    def test_a_departing_one_is_drawn_and_framed(self):
        one = self.drawings(growth_map(), growth_map([[1.0] * 4] * 3, check="uniform, sdirk2", as_expected=0))[""]
        frames = [panel.spines["left"].get_edgecolor() for panel in one.figure.axes[:2]]
        self.assertNotEqual(frames[0], frames[1])

    def test_real_motion_is_preferred(self):
        one = self.drawings(growth_map(), growth_map(check="moved, forward-euler"))[""]
        self.assertIn("on moved particles", one.caption)
        self.assertEqual(len(one.figure.axes), 2)

    def test_many_schemes_get_a_figure_per_lemma(self):
        found = [growth_map(subject=f"scheme {i}", statement=f"Lemma {lemma}, map")
                 for lemma in ("2.4", "3.3") for i in range(3 if lemma == "2.4" else 6)]
        found = [one | {"subject": f"{one['statement']} {one['subject']}"} for one in found]
        drawn = self.drawings(*found)
        self.assertEqual(list(drawn), ["lemma-2-4", "lemma-3-3"])
        self.assertEqual([len(titles(one.figure)) for one in drawn.values()], [3, 6])
        self.assertEqual(list(self.drawings(*found[:4])), [""])


class Curves(StabilityMapTest):
    def test_a_panel_per_scheme_and_a_curve_per_integrator_the_least_over_the_arrangements(self):
        found = [limit(statement=f"Lemma {lemma}, sharp in the max norm", check=f"{where}, {how}",
                       subject=f"{lemma} {who}", value=np.array((1.0, 1.5, 6.0)) * (2 if where == "jittered" else 1))
                 for lemma in ("2.4", "3.3") for where in ("uniform", "jittered") for how in ("forward-euler", "ssprk3")
                 for who in ("one", "two")]
        one = self.drawings(*found)["limits"]
        self.assertEqual(titles(one.figure), ["2.4 one", "2.4 two", "3.3 one", "3.3 two"])
        for panel in one.figure.axes:
            # The lemma's line, what the rows need, and the limits of two integrators.
            drawn = [list(y) for _, y in curves(panel)]
            self.assertEqual((len(drawn), drawn.count([1.0, 1.5, 6.0])), (4, 2))
            self.assertEqual(len(panel.collections), 2)     # up to the largest
        for word in ("forward-euler", "ssprk3", "CFL number 1, printed in the lemmas"):
            self.assertIn(word, legend(one.figure))
        self.assertEqual(one.statements, ("Lemma 2.4, sharp in the max norm", "Lemma 3.3, sharp in the max norm"))

    def test_a_limit_below_the_printed_condition_is_said(self):
        self.assertIn("suffices for every scheme", self.drawings(limit())["limits"].says)
        said = self.drawings(limit(value=(0.4, 1.5, 6.0)))["limits"].says
        self.assertIn("does not suffice for Model I, inverse: the least limit is 0.4", said)

    def test_no_limit_is_a_mark_above_and_no_stable_step_one_below(self):
        panel, = self.drawings(limit(value=(0.0, 2.0, 1000.0)))["limits"].figure.axes
        (x, y), = curves(panel, marker="^")
        self.assertEqual((list(x), bool(0.9 < y[0] < 1)), ([8.0], True))
        (x, y), = curves(panel, marker="x")
        self.assertEqual((list(x), bool(0 < y[0] < 0.1)), ([0.5], True))
        (_, y), = curves(panel, marker="o")
        np.testing.assert_array_equal(y, [math.nan, 2.0, math.nan])
        self.assertTrue(panel.get_ylim()[1] < 1000)

    def test_integrators_without_any_limit_are_left_out(self):
        found = limit(), limit(value=(1000.0,) * 3, check="uniform, backward-euler")
        self.assertNotIn("backward-euler", legend(self.drawings(*found)["limits"].figure))
        self.assertIn("backward-euler", legend(self.drawings(found[1])["limits"].figure))

    def test_points_of_curves_say_what_they_are(self):
        drawn = self.drawings(limit(), limit(subject="another"), growth_map(), curve(), positivity())
        for part, columns in (("limits", ("δ/h", "largest CFL number", "on other particles up to", "by the rows")),
                              ("growth", ("t", "growth")),
                              ("positivity", ("CFL number", "smallest entry", "part of the horizons with a bound"))):
            curves = [one for one in hover.curves(drawn[part].figure) if one.points]
            self.assertEqual({(one.name, one.columns) for one in curves}, {("forward-euler", columns)}, part)
        self.assertEqual(hover.curves(drawn["limits"].figure)[1].points[2][2:], ("8", "6", "6", "4"))

    def test_growth_has_a_panel_per_scheme_and_shows_finite_bounds(self):
        found = (curve(0.9, (1.0, 1.1, 1.2), upper=np.array([1.5, 2.0, 1e300])), curve(2),
                 curve(2, (1.0, 0.9, 1e300), "uniform, ssprk3"), curve(2, (2.0,), subject="SPH sum"))
        one = self.drawings(*found)["growth"]
        self.assertEqual(titles(one.figure), ["Model I, inverse", "SPH sum"])
        first, control = one.figure.axes
        drawn = [list(y) for _, y in curves(first)]
        self.assertIn([1.0, 1.1, 1.2], drawn)
        self.assertIn([1.0, 3.0, 9.0], drawn)
        self.assertTrue(any(y[:2] == [1.5, 2.0] and math.isnan(y[2]) for y in drawn))
        self.assertIn([2.0], [list(y) for _, y in curves(control)])
        self.assertEqual(legend(one.figure), ["forward-euler", "ssprk3", "CFL 0.9", "CFL 2", "what theory allows"])
        self.assertIn("δ = 2.5h", one.caption)
        self.assertTrue(first.get_ylim()[1] < 1e10)

    def test_constant_bounds_are_drawn_once(self):
        def bounds(*uppers):
            found = [curve(cfl, (1.0, 1.0, 1.0), upper=np.array(upper)) for cfl, upper in enumerate(uppers)]
            return [list(y) for _, y in curves(self.drawings(*found)["growth"].figure.axes[0], color="#C4C9CE")]

        self.assertEqual(bounds([1.0] * 3, [1.0] * 3), [[1.0] * 3])
        self.assertEqual(bounds([1.0] * 3, [2.0] * 3), [[1.0] * 3, [2.0] * 3])
        self.assertEqual(bounds([1.0, 2.0, 4.0], [1.0, 2.0, 5.0]), [[1.0, 2.0, 4.0], [1.0, 2.0, 5.0]])
        self.assertEqual(bounds([math.inf] * 3), [])

    def test_positivity_is_the_worst_over_the_horizons_and_says_where_it_is_promised(self):
        lower = np.array([-1e-11, -1e-11, -math.inf, -math.inf] + 2 * [-1e-11, -1e-11, -1e-11, -math.inf])
        one = positivity([[0.1, 0.0, -1.0, -3.0], [0.0, 0.2, 0.0, -2.0], [0.3] * 4], lower=lower)
        cfl, worst, promised = smallest_entries.worst_entries(self.study(one).findings[0])
        np.testing.assert_array_equal(cfl, CFL)
        np.testing.assert_array_equal(worst, [0.0, 0.0, -1.0, -3.0])
        np.testing.assert_allclose(promised, [1.0, 1.0, 2 / 3, 0.0])
        panel, = self.drawings(one)["positivity"].figure.axes
        fills = [(line.get_fillstyle(), list(line.get_xdata())) for line in panel.lines if line.get_marker() == "o"]
        self.assertEqual(fills, [("full", [0.5, 1.0]), ("left", [2.0]), ("none", [4.0])])

    def test_positivity_that_must_fail_is_starred(self):
        plain = self.drawings(positivity())["positivity"]
        starred = self.drawings(positivity(expected="violated", verdict="violated"))["positivity"]
        self.assertEqual(titles(plain.figure), ["Model I, inverse"])
        self.assertEqual(titles(starred.figure), ["Model I, inverse\u00a0*"])
        self.assertIn("expected to fail", starred.caption)
        self.assertNotIn("expected to fail", plain.caption)


class Table(StabilityMapTest):
    def rows(self, *found):
        """The cells of every row, without markup."""
        table = sharp_limits.html(self.study(*found))
        return [[re.sub("<[^>]*>", "", cell).strip() for cell in re.findall(r"<t[hd].*?</t[hd]>", row)]
                for row in table.split("<tr")[2:]]

    def test_a_row_has_bounds_and_the_range_of_both_limits(self):
        row, = self.rows(limit(), limit("spectral radius", (1.25, 2.0, 8.0)))
        self.assertEqual(row, ["Model I, inverse", "uniform", "forward-euler", "1 Lemma 2.4 suffices", "1", "1 – 6",
                               "1.25 – 8", "holds", "yes"])

    def test_a_row_per_scheme_arrangement_and_integrator(self):
        found = [limit(kind, check=f"{where}, {how}") for where in ("uniform", "jittered")
                 for how in ("forward-euler", "sdirk2") for kind in ("max norm", "spectral radius")]
        self.assertEqual([row[1:3] for row in self.rows(*found)],
                         [["uniform", "forward-euler"], ["uniform", "sdirk2"], ["jittered", "forward-euler"],
                          ["jittered", "sdirk2"]])

    def test_a_limit_below_one_says_that_the_lemma_does_not_suffice(self):
        def printed(*value):
            return self.rows(limit(value=value, lower=(0.3,) * 3))[0][3]

        self.assertEqual(printed(2.0, 0.9, 0.35), "1 Lemma 2.4 does not suffice")
        self.assertEqual(printed(2.0, 1.5, 1 - 1e-8), "1 Lemma 2.4 suffices")     # as good as the bisection is
        self.assertEqual(printed(2.0, 1.5, 1 - 1e-5), "1 Lemma 2.4 does not suffice")

    def test_extremes_are_words(self):
        def cells(value, lower, *more, **changes):
            return self.rows(limit(value=value, lower=lower, **changes), *more)[0][3:7]

        end = (999.999,) * 3
        self.assertEqual(cells((1000.0,) * 3, end), ["1 Lemma 2.4 suffices", "none up to 1000", "none up to 1000", "–"])
        self.assertEqual(cells((2.5, 7.0, 1000.0), (0.0,) * 3)[1:3], ["none promised", "2.5 – none up to 1000"])
        self.assertEqual(cells((1.0, math.nan, 2.0), (1.0,) * 3)[::2], ["1 Lemma 2.4 does not suffice", "nan"])
        self.assertEqual(cells((1000.0, 0.0, 0.0), (1.3,) * 3, expected="violated", verdict="violated")[::2],
                         ["1", "0: no step is stable – none up to 1000"])
        self.assertEqual(cells((1.0, 1.0, 1.0), (1.0,) * 3, upper=1.000001)[1], "1 exact")
        self.assertEqual(cells((1.0, 1.0, 1.1), (1.0,) * 3, upper=1.000001, as_expected=0)[1], "1")

    def test_what_departs_in_either_limit_is_marked(self):
        self.assertNotIn('class="departs"', sharp_limits.html(self.study(limit(), limit("spectral radius"))))
        wrong = limit("spectral radius", as_expected=0, verdict="violated")
        loud = sharp_limits.html(self.study(limit(), wrong))
        self.assertIn('class="departs"', loud)
        self.assertIn("expected holds", loud)

    def test_the_page_has_table_and_drawings_and_the_claims_lead_to_them(self):
        write(self.folder, "stable", kind="stability-map", findings=(growth_map(), limit(), curve(), positivity()))
        code, _, err = self.run_report(self.folder)
        self.assertEqual((code, err), (0, ""))
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        for words in ('id="stable.figure"', 'id="stable.limits.figure"', 'id="stable.growth.figure"',
                      'id="stable.positivity.figure"', "rows&#39; bound", "Every finding"):
            self.assertIn(words, page)
        for kind, stem in (("map", "stable"), ("growth curve", "stable.growth"), ("positivity", "stable.positivity"),
                           ("sharp in the max norm", "stable.limits")):
            row = next(row for row in page.split("<tr")[1:] if f">Lemma 2.4, {kind}</th>" in row)
            self.assertIn(f'href="#{stem}.figure"', row)
            other = "stable.positivity" if kind != "positivity" else "stable.growth"
            self.assertNotIn(f"#{other}.figure", row)


class Missing(StabilityMapTest):
    def test_each_part_alone_is_enough(self):
        parts = {"": growth_map(), "limits": limit(), "growth": curve(), "positivity": positivity()}
        for part, found in parts.items():
            self.assertEqual(list(self.drawings(found)), [part])
        self.assertEqual(self.drawings(), {})
        self.assertEqual(sharp_limits.html(self.study()), "")
        self.assertEqual(self.drawings(limit("spectral radius")), {})

    def test_one_ratio_and_one_cfl_number(self):
        found = (growth_map([[5.0]], (2.0,), (1.0,)), limit(value=(1.5,), lower=(1.0,), ratios=(2.0,)),
                 curve(2, (2.0,)), positivity([[-0.5]], (2.0,), (1.0,)))
        self.assertEqual(list(self.drawings(*found)), ["", "limits", "growth", "positivity"])

    def test_values_that_are_no_numbers(self):
        wild = [[math.nan, math.inf, -math.inf, 1.0], [math.nan] * 4, [math.inf] * 4]
        found = (growth_map(wild), limit(value=(math.nan, math.inf, 0.0), lower=(-math.inf,) * 3),
                 limit("spectral radius", (math.nan,) * 3), curve(2, (math.nan, math.inf, 0.0)), positivity(wild))
        self.assertEqual(list(self.drawings(*found)), ["", "limits", "growth", "positivity"])
        sharp_limits.html(self.study(*found))
        lost = (growth_map([[math.nan] * 4] * 3), limit(value=(math.nan,) * 3), curve(2, (math.nan,) * 3),
                positivity([[math.nan] * 4] * 3))
        self.assertEqual(list(self.drawings(*lost)), ["", "limits", "growth"])

    def test_a_study_without_a_scene_and_a_check_without_an_integrator(self):
        found = (growth_map(check="uniform"), limit(check="uniform"), curve(), positivity(check="uniform"))
        self.assertEqual(len(self.drawings(*found, scene=False)), 4)


if __name__ == "__main__":
    unittest.main()
