"""Figures as elements of a page: what matplotlib drew, small, in the page's colors, many in one page."""

import re
import unittest
from unittest import mock
from xml.etree import ElementTree

from tests.result_files import ReportTest  # puts reports/ on the path

import numpy as np

from matplotlib import _mathtext, axis

from drawing import hover, inlined, look, svg


def drawn(stem="fig1.cuts", draw=lambda panel: None):
    """The element of a figure with one panel."""
    with look.typography():
        figure = look.blank(2, 3)
        panel = look.add_axes(figure, 0.5, 0.4, 2, 1.4)
        panel.set(xlim=(0, 4), ylim=(0, 4))
        draw(panel)
    return look.render(look.Drawing(stem, "a <title>", figure, 'what is "seen"', "caption")).inline


class Inline(ReportTest):
    def test_it_is_a_small_element_without_fonts_or_prolog(self):
        found = drawn()
        root = ElementTree.fromstring(found)
        self.assertEqual((root.tag, root.get("data-figure"), root.get("aria-label")), ("svg", "fig1.cuts", 'what is "seen"'))
        for word in ("@font-face", "<?xml", "<!DOCTYPE", "metadata", "<title", "xmlns"):
            self.assertNotIn(word, found)
        self.assertLess(len(found), 5000)
        self.assertNotRegex(found, r"\d\.\d{3}")

    def test_identifiers_begin_with_the_stem_and_references_find_them(self):
        found = drawn(draw=lambda panel: (panel.plot([1, 2], [1, 2], marker="o"), panel.bar([1], [1], hatch="//")))
        ids = re.findall(r' id="([^"]*)"', found)
        self.assertTrue(ids and all(one.startswith("fig1.cuts.") for one in ids), ids)
        references = re.findall(r'url\(#([^)]*)\)|href="#([^"]*)"', found)
        self.assertEqual({one or other for one, other in references} - set(ids), set())

    def test_colors_are_properties_and_those_of_a_map_stay(self):
        found = drawn(draw=lambda panel: (panel.plot([1, 2], [1, 2], color=look.COLORS[0]),
                                          panel.axvspan(1, 2, color="#fee838")))
        for color in ("var(--c-0072b2,#0072b2)", "var(--ink,#000000)", "var(--paper,#ffffff)", '"#fee838"'):
            self.assertIn(color, found)
        self.assertIn("--ink:", inlined.dark(found))
        self.assertNotIn("--c-d55e00", inlined.dark(found))
        for color in (*look.COLORS, look.GRAY, look.DEPARTING):
            self.assertIn(color.lower(), inlined.DARK)

    def test_what_is_drawn_of_a_series_can_be_found(self):
        found = ElementTree.fromstring(drawn(draw=lambda panel: (
            panel.plot([1, 2, 3], [1, 2, 3], marker="o", gid="s:one & two"), panel.plot([1, 2], [2, 1], marker="o"))))
        group, = found.iterfind(".//g[@data-series]")
        self.assertEqual(group.get("data-series"), "one & two")
        self.assertEqual(len(list(group.iter("use"))), 3)

    def test_every_point_and_tick_stands_where_it_was_drawn(self):
        def draw(panel):
            panel.set_xticks([1, 2, 3])
            panel.set_yticks([])
            panel.plot(np.array([1, 3]), np.array([2, 2]), linestyle="none", marker="s")

        found = ElementTree.fromstring(drawn(draw=draw))
        # The panel begins at 36 pt, and 36 pt are a unit.
        self.assertEqual([use.get("x") for use in found.iter("use")], ["72", "144"])
        ticks, = (path.get("d") for path in found.iter("path") if path.get("d").count("M") == 3)
        self.assertEqual(re.findall(r"M([\d.]+)", ticks), ["72", "108", "144"])
        labels = [text for text in found.iter("text") if text.text in ("1", "2", "3")]
        self.assertEqual([text.get("x") for text in labels], ["72", "108", "144"])

    def test_no_tick_stands_outside_of_its_panel(self):
        def draw(panel):
            panel.set(xscale="log", xlim=(1e-17, 0.1), yscale="symlog", ylim=(-10, 5))

        for text in ElementTree.fromstring(drawn(draw=draw)).iter("text"):
            first = text if text.get("x") else text[0]
            self.assertTrue(0 < float(first.get("x")) < 190 and 0 < float(first.get("y")) < 144, text.attrib)

    def test_what_takes_long_is_not_done_twice(self):
        """matplotlib's own ticks are never made, and a formula is parsed once, whatever figures it is in."""
        def draw(panel):
            curve, = panel.plot([1, 2, 3], [1, 2, 3])
            hover.mark(curve, "one", N=[1, 2, 3])
            panel.set_xticks([1, 2], ["$10^{1}$", "two"])
            panel.set_xlabel("never before: $q^{17}$")

        with mock.patch.object(axis.Axis, "_get_tick", side_effect=AssertionError("a tick was made")):
            first = drawn(draw=draw)
        with mock.patch.object(_mathtext.Parser, "parse", side_effect=AssertionError("a formula was parsed again")):
            self.assertEqual(drawn(draw=draw), first)

    def test_a_formula_reads_from_left_to_right_at_its_place(self):
        found = ElementTree.fromstring(drawn(draw=lambda panel: panel.text(1, 1, r"$\max(h,\,\delta)$", fontsize=10)))
        text = next(text for text in found.iter("text") if len(text))
        self.assertEqual("".join(text.itertext()).replace(" ", ""), "max(h,δ)")
        self.assertAlmostEqual(float(text[0].get("x")), 72, delta=1)

    def test_fonts_have_the_letters_of_all_figures_once(self):
        self.assertEqual(svg.letters("<text>ab</text>", "<tspan>b&amp;δ</tspan>"), "&abδ")
        faces = svg.faces("abδ")
        self.assertEqual(faces.count("@font-face"), 2)
        self.assertLess(len(faces), 10000)


if __name__ == "__main__":
    unittest.main()
