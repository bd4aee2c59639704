"""The report on small synthetic result files: it shows everything, hides nothing, and stops cleanly at bad input."""

import json
import math
import multiprocessing
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading
import time
import unittest
from unittest import mock
from xml.etree import ElementTree

import h5py
import numpy as np

from tests.result_files import ROOT, ReportTest, finding, of_study, series, write

from drawing import axes, look, svg
from kinds import convergence, registry, run_times
from pages import mutants, page, run_time
from reading import names, results


def drawn(study, kind="svg"):
    """The figure of a study as text, or as the bytes of another kind of file."""
    image = look.image(convergence.error_figure(study, registry.styles([study])), study.title, kind)
    return image.decode() if kind == "svg" else image


def costs(studies):
    """The figures of error against run time."""
    return [drawing for scene, group in run_times.scenes(studies).items()
            for drawing in run_times.drawings(group, registry.styles(studies), scene)]


class Reading(ReportTest):
    def test_both_kinds_of_hdf5_text_are_read(self):
        for fixed_length in (False, True):
            path = write(self.folder, "fig1", series(mu=math.nan), title="Größe δ" if not fixed_length else "plain",
                         fixed_length=fixed_length)
            study = results.read_study(path)
            self.assertEqual(study.name, "fig1")
            self.assertEqual(study.findings[0].verdict, "confirmed")
            self.assertIsNone(study.findings[0].series.scheme.mu)
            self.assertEqual(study.scene.flow, "")
            self.assertEqual(list(study.findings[0].series.cases.N), [160, 320, 640, 1280])

    def test_a_column_more_is_passed_over_and_one_of_later_versions_may_be_missing(self):
        study = results.read_study(write(self.folder, "fig1", series(drift=np.arange(4))))
        self.assertTrue(np.isnan(study.findings[0].series.cases.last_time).all())

    def test_a_file_that_is_no_result_stops_with_4_and_one_line(self):
        incomplete, lacking, ragged = series(), series(), series(h=np.ones(3))
        del incomplete["verdict"], lacking["error_linf"]
        (self.folder / "junk.h5").write_text("not HDF5")
        with h5py.File(self.folder / "other.h5", "w") as file:
            file.attrs["format"] = "something else"
        write(self.folder, "incomplete", incomplete)
        write(self.folder, "lacking", lacking)
        write(self.folder, "ragged", ragged)
        write(self.folder, "outside", series(), study="../../outside")
        for name, said in (("junk", "not a readable HDF5 file"), ("other", 'format = "something else"'),
                           ("incomplete", "no attribute verdict"), ("lacking", "no dataset error_linf"),
                           ("ragged", "shape (3,)"),
                           ("outside", 'study = "../../outside"')):
            with self.subTest(name):
                code, out, err = self.run_report(self.folder, self.folder / f"{name}.h5")
                self.assertEqual((code, out, err.count("\n")), (4, "", 1), err)
                self.assertIn(said, err)
                self.assertIn(f"{name}.h5", err)
        self.assertEqual([file for file in self.folder.iterdir() if file.suffix != ".h5"], [])

    def test_bad_usage_stops_with_2_and_one_line(self):
        cost = write(self.folder, "cost", series())
        twin = self.folder / "twin.h5"
        empty = self.folder / "empty"
        empty.mkdir()
        twin.write_bytes(write(self.folder, "fig1", series()).read_bytes())
        for arguments in ([self.folder / "missing"], [empty], [empty, empty / "missing.h5"], [empty, cost],
                          [empty, twin, self.folder / "fig1.h5"]):
            with self.subTest(arguments):
                code, out, err = self.run_report(*arguments)
                self.assertEqual((code, out, err.count("\n")), (2, "", 1), err)
        self.assertEqual(self.run_report("--no-such-option")[0], 2)


class Page(ReportTest):
    def test_every_series_and_verdict_is_shown_and_escaped(self):
        verdicts = ("confirmed", "pre-asymptotic", "below", "above", "stagnates", "floor", "diverges", "unstable",
                    "inconclusive")
        all_series = [series(path=f"delta = {i + 2}h", verdict=verdict, expected=verdict, reason=f"reason <{verdict}>")
                      for i, verdict in enumerate(verdicts)]
        write(self.folder, "fig1", *all_series, title="<script>alert(1)</script> & $x$",
              study_text='title = "<b>"')
        code, out, err = self.run_report(self.folder)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(Path(out.strip()), self.folder / "index.html")
        html = (self.folder / "index.html").read_text(encoding="utf-8")
        for one in all_series:
            self.assertIn(f'>{one["verdict"]}</span>', html)
            self.assertIn(f'reason &lt;{one["verdict"]}&gt;', html)
            self.assertEqual(of_study(html, "fig1").count(f'<td class="said">{one["path"]}</td>'), 1)
        self.assertIn("&lt;script&gt;alert(1)&lt;/script&gt; &amp; $x$", html)
        self.assertIn("title = &#34;&lt;b&gt;&#34;", html)
        self.assertNotIn("<script>alert", html)
        for name in ("fig1", "cost.lee-du-2019"):
            self.assertEqual(html.count(f'<figure id="{name}.figure"'), 1)
        self.assertEqual(sorted(file.name for file in self.folder.iterdir()), [".report", "fig1.h5", "index.html"])

    def test_nothing_is_read_from_elsewhere(self):
        write(self.folder, "fig1", series())
        self.assertEqual(self.run_report(self.folder)[0], 0)
        html = (self.folder / "index.html").read_text(encoding="utf-8")
        for address in re.findall(r'(?:src|href|action)="([^"]*)"|url\(([^)]*)\)|@import', html):
            self.assertRegex("".join(address), r"^(#|data:)")

    def test_figures_become_files_of_the_formats_that_are_asked_for(self):
        write(self.folder, "fig1", series())
        to = self.folder / "figures"
        self.assertEqual(self.run_report(self.folder, "--figures", to, "--format", "svg,png")[0], 0)
        self.assertEqual(sorted(file.name for file in to.iterdir()),
                         ["cost.lee-du-2019.png", "cost.lee-du-2019.svg", "fig1.png", "fig1.svg"])
        self.assertEqual(self.run_report(self.folder, "--figures", to, "--format", "gif")[0], 2)
        self.assertEqual(self.run_report(self.folder, "--format", "svg")[0], 2)

    def test_parts_link_to_each_other_and_to_places_that_exist(self):
        write(self.folder, "fig1", series())
        write(self.folder, "ledger", kind="consistency", findings=[finding()])
        self.assertEqual(self.run_report(self.folder, "--folder")[0], 0)
        pages = {file.name: file.read_text(encoding="utf-8") for file in self.folder.glob("*.html")}
        self.assertEqual(sorted(pages), ["compatibility.html", "figures.html", "index.html", "lemmas.html",
                                         "run-time.html", "theorems.html"])
        for name, text in pages.items():
            for page_of, place in re.findall(r'<a href="([^"#]*)#([^"]*)"', text):
                self.assertIn(f' id="{place}"', pages[page_of or name])
        self.assertIn('<a href="lemmas.html#q.lemmas"', pages["figures.html"])
        self.assertIn('<link rel="stylesheet" href="page.css">', pages["index.html"])
        for name in ("page.css", "page.js"):
            self.assertTrue((self.folder / name).is_file())

    def test_a_departing_series_is_marked(self):
        departing = series(path="delta = h^2", verdict="below", as_expected=0, observed_order=0.5)
        control = series(path="delta = 0.2", verdict="stagnates", expected="stagnates")
        study = results.read_study(write(self.folder, "fig1", series(), departing, control))
        html = page.html([study], {})
        self.assertIn("1 of 3 series not as expected", html)
        self.assertLess(html.index('<tr class="departs">'), html.index('class="verdicts"'))   # in full, on top
        self.assertEqual(of_study(html, "fig1").count('<tr class="departs">'), 1)
        self.assertIn('<td class="mark bad">', html)
        self.assertIn("<strong>no</strong>, expected confirmed", html)
        self.assertIn('<span class="badge bad">below</span>', html)
        self.assertIn('<span class="badge control">stagnates</span>', html)
        self.assertIn("below, expected confirmed", drawn(study))

    def test_numbers_and_what_is_not_a_number(self):
        broken = series(error_linf=[0.0512, math.nan, math.inf, 0.00321], observed_order=math.nan,
                        observed_low=math.nan, observed_high=math.nan, verdict="unstable", expected="unstable",
                        work_pairs=np.array([1, 1000, 1234567, 10**12]))
        html = page.html([results.read_study(write(self.folder, "fig1", broken))], {})
        for text in ("5.120e-02", ">nan<", ">inf<", "1\u202f234\u202f567", "[–, –]", "Δ<var>t</var>"):
            self.assertIn(text, html)

    def test_program_runs_from_the_root_of_the_project(self):
        write(self.folder, "fig1", series())
        done = subprocess.run([sys.executable, "reports/report.py", str(self.folder)], cwd=ROOT, text=True,
                              capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, f"{self.folder / 'index.html'}\n")


def mutant(**changes):
    return dict(name="model1-tail", file="solver/line/model1.hpp", what="the outermost cell loses its tail",
                expected="caught", outcome="caught", caught=True, as_expected=True, seconds=1.5,
                caught_by=[{"kind": "test", "name": "moments <1>"}, {"kind": "gate", "name": "fig2: a"},
                           {"kind": "gate", "name": "fig2: b"}]) | changes


class SeededMistakes(ReportTest):
    survivor = dict(expected="survives", outcome="survives", caught=False, caught_by=[])

    def setUp(self):
        super().setUp()
        write(self.folder, "fig1", series())
        self.file = self.folder / mutants.FILE
        self.file.parent.mkdir()

    def section(self, *found):
        self.file.write_text(json.dumps({"mutants": found}), encoding="utf-8")
        code, _, err = self.run_report(self.folder)
        self.assertEqual((code, err), (0, ""))
        return (self.folder / "index.html").read_text(encoding="utf-8").partition('id="q.seeded-mistakes"')[2].partition(
            "<section")[0]

    def test_a_table_says_what_sees_each_mistake(self):
        html = self.section(mutant(), mutant(name="control-comment", **self.survivor))
        for text in ("1 of 1 seeded mistakes are caught", "1 of 1 harmless changes survive", "solver/line/model1.hpp",
                     "1 test, 2 gates", "test: moments &lt;1&gt;", "gate: fig2: b", "control: must survive"):
            self.assertIn(text, html)
        self.assertIn('class="outcome good"', html)
        self.assertNotIn('class="departs"', html)

    def test_what_departs_stands_out(self):
        html = self.section(mutant(), mutant(name="missed", outcome="survives", as_expected=False, caught_by=[]),
                            mutant(name="control-seen", expected="survives", as_expected=False),
                            mutant(name="stale", outcome="error", as_expected=False, caught_by=[], error="no <hunk>"))
        self.assertEqual(html.count('<tr class="departs">'), 3)
        self.assertLess(html.index("missed"), html.index("model1-tail"))
        for text in ("1 of 3 seeded mistakes are caught", "0 of 1 harmless changes survive", 'class="outcome bad"',
                     "<strong>no</strong>, expected caught", "<strong>no</strong>, expected survives",
                     "no &lt;hunk&gt;", '<span class="badge bad">survives</span>'):
            self.assertIn(text, html)

    def test_without_the_file_a_line_says_what_makes_it(self):
        code, _, _ = self.run_report(self.folder)
        html = (self.folder / "index.html").read_text(encoding="utf-8")
        self.assertEqual((code, html.count("make mutants")), (0, 1))

    def test_a_malformed_file_stops_with_4_and_one_line(self):
        without = mutant()
        del without["caught_by"]
        for text in ("{", "[]", "{}", '{"mutants": 3}', '{"mutants": ["a"]}', json.dumps({"mutants": [without]}),
                     json.dumps({"mutants": [mutant(what=7)]}), json.dumps({"mutants": [mutant(as_expected="no")]}),
                     json.dumps({"mutants": [mutant(caught_by=["x"])]})):
            with self.subTest(text):
                self.file.write_text(text, encoding="utf-8")
                code, out, err = self.run_report(self.folder)
                self.assertEqual((code, out, err.count("\n")), (4, "", 1), err)
                self.assertIn(f"{self.file}: ", err)
                self.assertFalse((self.folder / "index.html").exists())


@unittest.skipUnless(multiprocessing.get_start_method() == "fork" and hasattr(os, "sched_getaffinity"),
                     "the drawing processes have to inherit what is patched here")
class Stopping(ReportTest):
    def draw(self, render):
        """(exit code, stdout, stderr) with `render` in place of the rendering, in two processes."""
        write(self.folder, "fig1", series())
        write(self.folder, "fig2", series())
        with mock.patch("os.sched_getaffinity", lambda _: {0, 1}), mock.patch("drawing.look.render", render):
            stopped = self.run_report(self.folder)
        self.assertFalse((self.folder / "index.html").exists())
        self.assertEqual(multiprocessing.active_children(), [])
        return stopped

    def test_a_killed_drawing_process_stops_with_4_and_one_line(self):
        code, out, err = self.draw(lambda *_: os.kill(os.getpid(), signal.SIGKILL))
        self.assertEqual((code, out, err.count("\n")), (4, "", 1), err)
        self.assertIn("a drawing process was killed", err)

    def test_an_interrupt_ends_it_at_once(self):
        timer = threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT))
        self.addCleanup(timer.cancel)
        timer.start()
        start = time.monotonic()
        code, out, err = self.draw(lambda *_: time.sleep(60))
        self.assertEqual((code, out, err.count("\n")), (130, "", 1), err)
        self.assertLess(time.monotonic() - start, 20)


class Figures(ReportTest):
    def test_an_order_of_the_law_with_a_correction_is_called_that_of_the_limit(self):
        corrected = series(extrapolated_order=0.97, observed_fitted=0.91)
        study = results.read_study(write(self.folder, "fig1", corrected, series(path="delta = h^2")))
        text = drawn(study)
        self.assertIn(">limit order 0.97 [0.95, 1.01], theory 1<", text)
        self.assertIn(">order 0.97 [0.95, 1.01], theory 1<", text)
        html = page.html([study], {})
        self.assertIn('<td class="n">0.97 [0.95, 1.01]</td><td class="n">0.91</td>', html)

    def test_the_same_file_gives_the_same_bytes(self):
        path = write(self.folder, "fig1", series(), series(divergence="nonlocal"), series(path="delta = sqrt(h)"))
        for kind in ("svg", "png"):
            first, second = (drawn(results.read_study(path), kind) for _ in range(2))
            self.assertEqual(first, second)
        self.assertNotIn("<dc:date>", drawn(results.read_study(path)))

    def test_levels_that_cannot_be_drawn_are_counted_in_the_legend(self):
        mixed = series(error_linf=[0.05, math.nan, math.inf, 0.006])
        lost = series(divergence="nonlocal", error_linf=[math.nan] * 4, seconds=np.zeros(4))
        zero = series(path="delta = h^2", error_linf=[0.1, 0.01, 0.001, 0.0])
        short = series(path="delta = h^3", N=(160,))
        none = series(path="delta = h^4", N=())
        study = results.read_study(write(self.folder, "fig1", mixed, lost, zero, short, none))
        text = drawn(study)
        for note in ("2 of 4 levels not finite", "4 of 4 levels not finite", "1 of 4 levels zero"):
            self.assertIn(note, text)
        self.assertEqual(list(run_times.scenes([study])), ["lee-du-2019"])
        alone = results.read_study(write(self.folder, "fig2", lost))
        self.assertIn("4 of 4 levels not finite", drawn(alone))
        self.assertIn("nan", page.html([study], {}))

    def test_differences_to_a_finer_run_are_not_called_errors(self):
        path = write(self.folder, "unsolved", series())
        with h5py.File(path, "r+") as file:
            del file["scene"].attrs["u"]
            file["scene"].attrs["u0"] = "exp(sin(x))"
        study = results.read_study(path)
        drawing = convergence.drawings(study, registry.styles([study]))[0]
        self.assertIn("differences to a finer run", drawing.caption)
        self.assertIn("max-norm difference to a finer run", drawn(study))
        self.assertIn("initial values u0", page.html([study], {}))
        # Nor do they stand beside errors over run time.
        self.assertEqual(run_times.scenes([study]), {})

    def test_a_study_without_series_has_no_figure(self):
        study = results.read_study(write(self.folder, "fig1"))
        self.assertIsNone(convergence.error_figure(study, {}))
        self.assertEqual(run_times.scenes([study]), {})
        self.assertIn("No series has been run", page.html([study], {}))

    def test_series_run_by_several_studies_are_drawn_once(self):
        studies = [results.read_study(path) for path in (
            write(self.folder, "fig2", series(), series(divergence="nonlocal", N=(160, 320))),
            write(self.folder, "fig5", series(), series(divergence="nonlocal"), series(step_text="h/8")))]
        chosen = run_times.cost_curves(studies)
        self.assertEqual([(study.name, one.scheme.divergence, one.step_text, len(one.cases)) for study, one in chosen],
                         [("fig2", "local", "h/4", 4), ("fig5", "nonlocal", "h/4", 4), ("fig5", "local", "h/8", 4)])
        drawing, = costs(studies)
        text = look.image(drawing.figure, drawing.title, "svg").decode()
        for name in ("Model I, local divergence, step h/4", "Model I, local divergence, step h/8",
                     "Model I, nonlocal divergence"):
            self.assertEqual(text.count(f">{name}<"), 1, name)

    def test_run_times_have_a_figure_per_scene_and_name_the_cheapest_run(self):
        slow = series(divergence="nonlocal", seconds=1e-3 * np.array((160, 320, 640, 1280)))
        paths = [write(self.folder, "fig1", series(), slow), write(self.folder, "fig2", series())]
        with h5py.File(paths[1], "r+") as file:
            file["scene"].attrs["T"] = 2.0
        studies = [results.read_study(path) for path in paths]
        first, second = costs(studies)
        self.assertEqual([first.stem, second.stem], ["cost.lee-du-2019", "cost.lee-du-2019-to-t-2"])
        self.assertEqual([curve.scene for curve in run_time.curves(studies, [])],
                         ["lee-du-2019"] * 2 + ["lee-du-2019 to T = 2"])
        # The error is 1.3 h, so 0.03 takes h = 2 pi / 320.
        self.assertIn("of at most 0.1 in 0.0016 s (Model I, local divergence, δ = 4h, N = 160); 0.03 in 0.0032 s",
                      first.says)
        texts = [text.get_text() for text in first.figure.axes[0].texts]
        self.assertEqual(texts, ["160", "320", "640", "1280"])      # of the frontier, where the slow one has no part

    def test_panels_span_as_many_decades_and_curves_on_one_another_are_said(self):
        twin = series(divergence="nonlocal", error_linf=1.302 * 2 * math.pi / np.array((160, 320, 640, 1280)))
        narrow = series(path="delta = sqrt(h)", variable=np.array((0.2, 0.14, 0.1, 0.07)))
        study = results.read_study(write(self.folder, "fig1", series(), twin, narrow))
        figure = convergence.error_figure(study, registry.styles([study]))
        spans = [panel.get_xlim()[1] / panel.get_xlim()[0] for panel in figure.axes]
        self.assertAlmostEqual(spans[0], spans[1])
        said = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
        self.assertIn("within 0.15 % of Model I, local", said[1])
        self.assertNotIn("within", said[0])
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["Model I, local divergence", "Model I, nonlocal divergence"])

    def test_schemes_keep_their_looks_and_no_two_share_one(self):
        schemes = [series(model=model, divergence=divergence, kernel=kernel, mu=1.5 if model == 2 else math.nan)
                   for model, kernel in ((1, "inverse"), (2, "cubic-spline"), (1, "cubic-spline"), (1, "power"))
                   for divergence in ("local", "nonlocal")]
        study = results.read_study(write(self.folder, "fig1", *schemes))
        styles = registry.styles([study])
        self.assertEqual(len({(style.color, style.marker, style.filled) for style in styles.values()}), 8)
        self.assertTrue(all(style.filled == (scheme.divergence == "local") for scheme, style in styles.items()))
        self.assertIn("Model I, power kernel, local divergence",
                      names.scheme_names(styles).values())

    def test_reference_lines_stay_below_every_curve_and_each_other(self):
        h = 2 * math.pi / np.array([160, 320, 640, 1280])
        for errors in (h, h**0.5, 1e-3 + 0 * h, 1 / h, h**4, np.array([0.1, 0.01, 0.02, 0.001])):
            (low, high), (lines,) = axes.error_bounds([([(h, errors, None)], [1.0, 2.0])], (2.6, 2.6))
            self.assertEqual([line.order for line in lines], [1.0, 2.0])
            for line in lines:
                drawn = h[h >= line.start]
                self.assertTrue(np.all(line(drawn) < np.interp(drawn, h[::-1], errors[::-1])))
                self.assertGreater(line(line.start), low)
            self.assertLess(lines[1](lines[1].end), lines[0](lines[0].end))
            self.assertGreater(high, errors.max())

    def test_ticks_never_crowd_and_never_lack(self):
        for low, high in ((1e-16, 10), (0.002, 0.02), (0.05, 0.14), (0.1, 0.11), (3e-6, 5e-6), (0.99999, 1.00001)):
            with self.subTest((low, high)):
                ticks = axes._ticks(low, high, 5)
                self.assertTrue(2 <= len(ticks) <= 5, ticks)
                self.assertTrue(all(low <= tick <= high for tick in ticks))
                self.assertEqual(len({axes.tick_text(tick, ticks) for tick in ticks}), len(ticks))

    def test_paths_are_set_as_formulas_where_they_are_some(self):
        for path, written in (("delta = 4h", r"$\delta=4h$"), ("delta = sqrt(h)", r"$\delta=\sqrt{h}$"),
                              ("delta = 2*h^0.5", r"$\delta=2h^{0.5}$"), ("fixed horizon", "fixed horizon"),
                              ("costs $5", r"costs \$5"), ("a_b^", "a_b^")):
            self.assertEqual(names.path_math(path), written)

    def test_formulas_in_an_svg_read_from_left_to_right(self):
        text = svg.readable("""<text><tspan style="font: 12px 'STIXGeneral'" x="0 9 15 21 31 42" y="-1">max(,)</tspan>
            <tspan style="font: italic 12px 'STIXGeneral'" x="25 37" y="-1">hδ</tspan></text>""")
        self.assertEqual("".join(part.split("<")[0] for part in text.split(">")), "max(h,δ)")
        self.assertIn("STIXGeneral, 'STIX Two Text'", text)

    def test_a_figure_brings_its_fonts_along_and_keeps_its_text(self):
        study = results.read_study(write(self.folder, "fig1", series()))
        text = drawn(study)
        ElementTree.fromstring(text)
        self.assertEqual(text.count("@font-face{font-family:STIXGeneral"), 2)
        self.assertIn(">order 0.97 [0.95, 1.01], theory 1<", text)
        self.assertIn(">order 1<", text)


if __name__ == "__main__":
    unittest.main()
