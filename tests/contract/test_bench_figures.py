"""What is computed and drawn of benches, from synthetic ones."""

import json
import math
import unittest

import numpy as np

from tests.result_files import ReportTest, series, write

from kinds.bench import figures as bench_figures, tables as bench_tables
from reading import bench_results, results, work_precision

WORK = ("weight_builds", "quadrature_points", "velocity_evaluations", "flow_evaluations")


def case(N, delta, seconds, error, threads=1, steps=None, deviation=0.01):
    h = 2 * math.pi / N
    neighbors = max(delta / h, 1.0)
    steps = steps or 4 * N
    spread = {"median": seconds, "minimum": 0.98 * seconds, "deviation": deviation * seconds}
    parts = {name: {key: value * share for key, value in spread.items()} for name, share in
             zip(bench_results.PARTS, (0.2, 0.1, 0.5, 0.15))}
    return {"N": N, "h": h, "delta": delta, "dt": 1 / steps, "steps": steps, "stages": 1, "threads": threads,
            "error_linf": error, "failure": "",
            "work": {"pairs": round(N * steps * neighbors), **dict.fromkeys(WORK, 1)}, "seconds": spread, **parts,
            "samples": {"round": [1], "session": [1], "seconds": [seconds]}}


def path(cases, **changes):
    attributes = dict(study="fig", title="A figure", model=1, divergence="local", kernel="inverse", path="delta = 4h",
                      delta="4*h", source="local", integrator="forward-euler", step="h/4", stepping="",
                      motion="moving", scene="lee-du-2019", T=1, theory_order=1, threads=1)
    return attributes | changes, cases


def first_order(N=(160, 320, 640, 1280), ratio=4, of=lambda N: 1e-8 * N * N, **changes):
    """A path of errors 10 / N."""
    return path([case(n, ratio * 2 * math.pi / n, of(n), 10 / n, threads=changes.get("threads", 1)) for n in N],
                **changes)


class BenchFiles(ReportTest):
    def write_bench(self, *paths, name="bench", **changes):
        cases, stored = [], []
        for attributes, of_path in paths:
            stored.append({**attributes, "cases": list(range(len(cases), len(cases) + len(of_path)))})
            cases += of_path
        provenance = dict(created="2026-01-01T00:00:00Z", machine="a <machine>", system="Linux", version="0.1.0",
                          compiler="GNU 12", flags="-O3", command="acstudy bench fig.toml")
        bench = {"format": "acstudy-bench-1", "complete": True, "runs": 5, "least_seconds": 0.2,
                 "provenance": provenance, "series": stored, "cases": cases} | changes
        file = self.folder / name / "bench.json"
        file.parent.mkdir(exist_ok=True)
        file.write_text(json.dumps(bench), encoding="utf-8")
        return file

    def curve(self, *paths):
        return bench_results.read_bench(self.write_bench(*paths)).curves[0]


class Computed(BenchFiles):
    def test_seconds_to_reach_an_error_are_on_the_power_law_between_two_levels(self):
        curve = self.curve(first_order())
        found = work_precision.reach(curve, 10 / 450)
        self.assertEqual(found.kind, "between")
        self.assertAlmostEqual(found.seconds, 1e-8 * 450 ** 2, delta=1e-12)

    def test_beyond_the_levels_nothing_is_said_unmarked(self):
        curve = self.curve(first_order())
        coarse = work_precision.reach(curve, 0.1)
        self.assertEqual((coarse.kind, coarse.seconds), ("coarsest", curve.seconds.median[0]))
        beyond = work_precision.reach(curve, 10 / 5000)
        self.assertEqual(beyond.kind, "beyond")
        self.assertAlmostEqual(beyond.seconds, 1e-8 * 5000 ** 2, delta=1e-9)
        self.assertEqual(work_precision.reach(curve, 10 / 5200).kind, "not")
        rows = bench_tables.reach_table([curve])[1]
        self.assertEqual(rows[0][4:], ("0.01", "~ 0.11 *", "not reached"))

    def test_errors_that_settle_or_are_not_there_reach_nothing(self):
        settled = path([case(N, 0.5, 1e-8 * N * N, 0.05) for N in (160, 320, 640)])
        self.assertEqual(work_precision.reach(self.curve(settled), 1e-2).kind, "not")
        lost = {**case(160, 0.5, 1.0, None), "failure": "grew"}
        for name in ("seconds", "samples", *bench_results.PARTS):
            del lost[name]
        self.assertEqual(work_precision.reach(self.curve(path([lost])), 1e-2).kind, "none")
        self.assertIn("no solution", bench_tables.reach_table([self.curve(path([lost]))])[1][0])

    def test_the_frontier_is_what_nothing_beats(self):
        cost, error = [1, 2, 3, 4, 4, math.nan], [8, 9, 4, 5, 3, 0.1]
        self.assertEqual(list(work_precision.frontier(cost, error)), [True, False, True, False, True, False])
        self.assertEqual(list(work_precision.frontier([1, 1], [2, 1])), [False, True])

    def test_the_law_finds_the_exponents_and_says_when_it_is_none(self):
        N, neighbors = np.tile([100, 200, 400, 800], 3), np.repeat([2, 4, 16], 4)
        exact = work_precision.fit_law(N, neighbors, 3e-8 * N ** 1.9 * neighbors ** 0.7)
        for value, expected in ((exact.C, 3e-8), (exact.a, 1.9), (exact.b, 0.7), (exact.rms, 0)):
            self.assertAlmostEqual(value, expected, places=10)
        # A sum is no power law: the interval and the deviations say so.
        bent = work_precision.fit_law(N, neighbors ** 2, N ** 2 * (10.0 + neighbors ** 2))
        self.assertGreater(bent.rms, 0.05)
        self.assertGreater(bent.b_interval[1] - bent.b_interval[0], 0.1)
        self.assertIsNone(work_precision.fit_law(N, N / 50, N ** 2.0), "N and neighbors together")
        self.assertIsNone(work_precision.fit_law(N[:4], neighbors[:4], N[:4] ** 2.0), "few cases")

    def test_the_interval_contains_the_truth_as_often_as_it_says(self):
        """Roughly: a resampled interval of 16 cases is somewhat narrow. One of half the width must fail."""
        random = np.random.default_rng(7)
        N, neighbors = np.tile([100.0, 200, 400, 800], 4), np.repeat([1.0, 4, 16, 64], 4)
        inside = narrow = 0
        for _ in range(40):
            law = work_precision.fit_law(N, neighbors, N ** 2 * neighbors * np.exp(0.1 * random.normal(size=16)))
            inside += law.a_interval[0] <= 2 <= law.a_interval[1]
            half = (law.a_interval[1] - law.a_interval[0]) / 4
            narrow += abs(law.a - 2) <= half
        self.assertGreaterEqual(inside, 34)
        self.assertLess(narrow, 34)

    def test_noise_and_set_up_take_no_part_in_the_law(self):
        clean = [first_order(ratio=ratio, of=lambda N, r=ratio: 1e-7 * N ** 2 * r, path=f"delta = {ratio}h")
                 for ratio in (2, 8)]
        noisy = path([case(200, 1.0, 77.0, 0.1, deviation=0.2), case(100, 1.0, 1e-3, 0.1)], path="delta = 1")
        curves = bench_results.read_bench(self.write_bench(*clean, noisy)).curves
        cost, = work_precision.costs(curves).values()
        self.assertAlmostEqual(cost.seconds.a, 2, places=9)
        self.assertAlmostEqual(cost.seconds.b, 1, places=9)
        self.assertEqual((cost.seconds.cases, cost.seconds.left_out), (8, 2))

    def test_prices_are_those_of_the_sum(self):
        N = np.array([100.0, 200, 400, 800, 100, 200, 400, 800])
        updates, pairs = 4 * N * N, 4 * N * N * np.repeat([2.0, 30.0], 4)
        prices = work_precision.fit_prices(updates, pairs, 1e-3 + 5e-9 * updates + 2e-10 * pairs)
        for value, expected in ((prices.setup, 1e-3), (prices.per_update, 5e-9), (prices.per_pair, 2e-10)):
            self.assertAlmostEqual(value / expected, 1, places=6)
        self.assertLess(prices.rms, 1e-9)
        self.assertGreater(work_precision.fit_prices(updates, pairs, 1e-7 * N ** 1.5).rms, 0.05)

    def test_studies_that_asked_for_parts_of_a_curve_make_one(self):
        coarse, fine = first_order((160, 320)), first_order((640, 1280), study="fine")
        other = first_order((160, 320), study="other", step="h/8")
        curves = bench_results.read_bench(self.write_bench(fine, coarse, other)).curves
        self.assertEqual([list(curve.N) for curve in curves], [[160, 320, 640, 1280], [160, 320]])
        self.assertEqual(curves[0].studies, ("fine", "fig"))
        self.assertEqual([label.endswith(("step h/4", "step h/8")) for label in bench_tables.labels(curves)], [True] * 2)

    def test_threads_are_compared_within_one_bench(self):
        def two(seconds):
            return first_order((640,), of=lambda N: seconds, threads=2)
        alone = self.write_bench(first_order((640,), of=lambda N: 0.5), two(0.25))
        self.write_bench(two(0.1), name="bench-other")
        rows = bench_tables.thread_table(bench_results.read_all(self.folder))[1]
        self.assertEqual([row[-1] for row in rows], ["2.00"], alone)


class Drawn(BenchFiles):
    def paths(self):
        return [first_order(ratio=ratio, path=f"delta = {ratio}h", model=model, kernel=kernel, mu=mu,
                            of=lambda N, r=ratio: 1e-8 * N * N * (3 + r))
                for ratio in (4, 8) for model, kernel, mu in ((1, "inverse", None), (2, "cubic-spline", 1.5))]

    def drawings(self, *paths):
        self.write_bench(*paths)
        return {one.stem: one for one in bench_figures.drawings(bench_results.read_all(self.folder), {})}

    def test_a_panel_per_path_with_every_scheme_and_the_frontier(self):
        drawn = self.drawings(*self.paths())
        self.assertEqual(list(drawn), ["bench.seconds", "bench.work", "bench.parts"])
        for stem in ("bench.seconds", "bench.work"):
            panels = drawn[stem].figure.axes
            self.assertEqual(len(panels), 2)
            for panel in panels:
                # The frontier, and for each scheme its line and the caps of its bars.
                lines = [line for line in panel.lines if line.get_marker() in "os^Dv<" and line.get_linestyle() != "None"]
                self.assertEqual(len(lines), 2)
                halo, = (line for line in panel.lines if line.get_markersize() == 13)
                self.assertEqual(len(halo.get_xdata()), 4)
        bars = [patch for patch in drawn["bench.parts"].figure.axes[0].patches]
        self.assertEqual(len(bars), 4 * 5)
        for first in range(0, 20, 5):
            self.assertAlmostEqual(sum(bar.get_width() for bar in bars[first:first + 5]), 100)

    def test_scaling_studies_have_a_figure_of_their_own(self):
        along_N = path([case(N, 0.2, 1e-8 * N * N, 0.1, steps=100) for N in (640, 1280)], study="scaling-n")
        along_horizon = [path([case(640, ratio * 2 * math.pi / 640, 1e-4 * ratio, 0.1)], study="scaling-horizon",
                              path=f"delta = {ratio}h") for ratio in (1, 2, 4)]
        threads = [first_order((640,), of=lambda N, n=n: 1 / n, study="scaling-threads", threads=n) for n in (1, 2)]
        drawn = self.drawings(along_N, *along_horizon, *threads)
        self.assertEqual(list(drawn), ["bench.scaling"])
        self.assertEqual([panel.get_xlabel() for panel in drawn["bench.scaling"].figure.axes],
                         ["$N$", r"$\delta/h$", "threads"])

    def test_a_report_of_a_bench_alone_and_beside_studies(self):
        self.write_bench(*self.paths())
        for alone in (True, False):
            self.assertEqual(self.run_report(self.folder)[:2], (0, f"{self.folder / 'index.html'}\n"))
            page = (self.folder / "index.html").read_text(encoding="utf-8")
            for text in ("a &lt;machine&gt;", 'id="bench.seconds.figure"', "Seconds to reach an error", "Prices of work",
                         "Where the time goes"):
                self.assertIn(text, page)
            self.assertEqual("<article" in page, not alone)
            write(self.folder, "fig", series())

    def test_without_a_bench_the_page_says_what_makes_one(self):
        write(self.folder, "fig", series())
        self.assertEqual(self.run_report(self.folder)[0], 0)
        self.assertIn("make bench", (self.folder / "index.html").read_text(encoding="utf-8"))

    def test_a_damaged_bench_stops_with_4_and_one_line(self):
        file = self.write_bench(*self.paths())
        good = file.read_text(encoding="utf-8")
        for text, reason in (("{", "Expecting"), ("[]", "not of format"), (good.replace("bench-1", "bench-9"), "not of format"),
                             (good.replace('"pairs"', '"pears"'), "no entry 'pairs'")):
            file.write_text(text, encoding="utf-8")
            code, out, err = self.run_report(self.folder)
            self.assertEqual((code, out, err.count("\n")), (4, "", 1), text[:50])
            self.assertIn(f"{file}: {reason}", err)
            self.assertRaises(results.ResultError, bench_results.read_bench, file)


if __name__ == "__main__":
    unittest.main()
