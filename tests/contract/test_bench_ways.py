"""Benches of studies that step in several ways: which way reaches which error, and what a step costs."""

import re
import subprocess
import sys
import unittest

from tests.contract.test_bench_figures import BenchFiles, case, first_order, path
from tests.program import ROOT

from kinds.bench import way_figures, ways
from reading import bench_results

LOST = {"failure": "the solution has grown to 1e7", "error_linf": None}
WAYS = {("forward-euler", "0.9 cfl"): 1.0, ("forward-euler", "0.9 cfl by rows"): 3.0, ("sdirk2", "h/2"): 4.0}


def stepped(integrator, step, slower=1.0, title="Compression", **changes):
    """A series of errors 10 / N in one of several ways to step."""
    return first_order((160, 320, 640), of=lambda N: slower * 1e-8 * N * N,
                       **dict(study=f"stiff-{title.lower()}", title=title, integrator=integrator, step=step,
                              stepping=f"{integrator}, step {step}") | changes)


def lost(**changes):
    attributes, cases = stepped("forward-euler", "h/4", **changes)
    for one in cases:
        one.update(LOST)
        for name in ("seconds", "samples", *bench_results.PARTS):
            del one[name]
    return attributes, cases


class Ways(BenchFiles):
    def tables(self, *paths):
        self.write_bench(*paths, name="bench-stiff")
        return ways.tables(bench_results.read_all(self.folder))

    def test_the_quickest_way_is_marked_and_what_blows_up_is_named(self):
        reached, costs = self.tables(*(stepped(*way, slower) for way, slower in WAYS.items()), lost())
        title, header, rows, note = reached
        self.assertEqual(title, "Compression: seconds to reach an error")
        self.assertEqual(header, ("steps", "delta = 4h: 1e-1", "delta = 4h: 3e-2"))      # no way reaches the others
        self.assertEqual(rows, [("forward-euler, by the lemma", "**< 2.6e-04**", "**0.0011**"),
                                ("forward-euler, by rows", "< 7.7e-04", "0.0033"),
                                ("sdirk2, equal steps", "< 0.001", "0.0044"),
                                ("forward-euler, equal steps", "blows up", "blows up")])
        self.assertIn("Model I", note)
        self.assertEqual(costs[1][4:], ("forward-euler, by the lemma", "forward-euler, by rows", "sdirk2, equal steps",
                                        "forward-euler, equal steps"))
        # 1e-8 N^2 seconds of 4 N steps of N particles are 2.5 ns.
        self.assertEqual(costs[2], [("Compression", "delta = 4h", "Model I", "640", "2.5", "7.5 (3)", "10 (4)", "blows up")])

    def test_a_way_is_all_of_its_steps_and_tolerances_and_the_best_of_them_count(self):
        # Long steps are quick and rough; their finest run is beaten by the coarsest of short ones.
        rough = path([case(N, 0.1, 1e-3 * N / 160, 0.3, steps=N) for N in (160, 320)], study="s", title="S",
                     integrator="sdirk2", step="2*h", stepping="sdirk2, step 2*h")
        fine = path([case(N, 0.1, 1.5e-3 * N / 160, 8 / N) for N in (160, 320)], study="s", title="S",
                    integrator="sdirk2", step="h/2", stepping="sdirk2, step h/2")
        adaptive = [path([case(320, 0.1, seconds, error)], study="s", title="S", integrator="sdirk2",
                         step=f"adaptive, tolerance {tolerance}", stepping=f"sdirk2, adaptive, tolerance {tolerance}")
                    for tolerance, seconds, error in ((0.1, 2e-3, 0.2), (0.01, 4e-3, 0.02))]
        self.write_bench(rough, fine, *adaptive, name="bench-stiff")
        (found,), = (groups.values() for groups in ways.scenes(bench_results.read_all(self.folder)).values())
        self.assertEqual(list(found), ["sdirk2, equal steps", "sdirk2, adaptive"])
        efficient = found["sdirk2, equal steps"].efficient()
        self.assertEqual([*zip(efficient.said, efficient.N)], [("2*h", 160), ("h/2", 160), ("h/2", 320)])
        self.assertEqual(found["sdirk2, adaptive"].said, ("adaptive, tolerance 0.1", "adaptive, tolerance 0.01"))
        reach = ways.reach(found["sdirk2, adaptive"], 0.1)
        self.assertEqual(reach.kind, "between")
        self.assertTrue(2e-3 < reach.seconds < 4e-3)
        # Nothing is extrapolated: with N fixed, error and time of steps say nothing of what lies beyond.
        self.assertEqual(ways.reach(found["sdirk2, adaptive"], 0.01).kind, "not")

    def test_scenes_are_never_mixed(self):
        """Though they have no name, the same final time and paths of one name."""
        tables = self.tables(*(stepped(*way, slower, title=title, scene="") for title in ("Compression", "Layers")
                               for way, slower in WAYS.items()))
        self.assertEqual([title for title, *_ in tables], ["Compression: seconds to reach an error",
                                                           "Layers: seconds to reach an error", "What a step costs"])
        drawings = way_figures.drawings(bench_results.read_all(self.folder))
        self.assertEqual([drawing.stem for drawing in drawings], ["bench.ways.compression", "bench.ways.layers"])

    def test_two_schemes_share_a_cell_and_a_figure(self):
        tables = self.tables(*(stepped(*way, slower, model=model) for model in (1, 2) for way, slower in WAYS.items()))
        self.assertEqual(tables[0][2][2], ("sdirk2, equal steps", "< 0.001 / < 0.001", "0.0044 / 0.0044"))
        figure = way_figures.drawings(bench_results.read_all(self.folder))[0].figure
        self.assertEqual(len(figure.axes), 2)

    def test_the_program_prints_them_alone_and_the_page_has_all(self):
        self.write_bench(first_order())
        self.write_bench(*(stepped(*way, slower) for way, slower in WAYS.items()), lost(), name="bench-stiff")
        for option, there, absent in (("--ways", "What a step costs", "Law of cost"),
                                      ("", "Seconds to reach an error", "What a step costs")):
            done = subprocess.run([sys.executable, ROOT / "reports" / "bench_tables.py", *option.split(), self.folder],
                                  text=True, capture_output=True, check=False, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"**{there}", done.stdout)
            self.assertNotIn(absent, done.stdout)
            self.assertEqual(done.stdout.count("Measured 2026-01-01"), 1)
        self.assertEqual(self.run_report(self.folder)[0], 0)
        page = (self.folder / "index.html").read_text(encoding="utf-8")
        for words in ('data-figure="bench.ways.compression"', "Compression: seconds to reach an error", "What a step costs",
                      "<strong>&lt; 2.6e-04</strong>", "forward-euler, equal steps: blows up"):
            self.assertIn(words, page)
        self.assertFalse(re.search(r"\*\*(<|&lt;|[0-9])", page))

    def test_without_such_a_bench_the_program_says_so(self):
        self.write_bench(first_order())
        done = subprocess.run([sys.executable, ROOT / "reports" / "bench_tables.py", "--ways", self.folder], text=True,
                              capture_output=True, check=False, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no bench of studies that step in several ways", done.stderr)


if __name__ == "__main__":
    unittest.main()
