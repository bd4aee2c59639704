"""acstudy bench: what is measured, stored and refused; and its coarse twin of `make bench`."""

import json
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

from tests.program import ACSTUDY, MODEL_II, ROOT, STUDY, ProgramTest, edit

sys.path.insert(0, str(ROOT / "reports"))
from reading import bench_results, work_precision

# Horizons are a small part of the period; the count of larger ones is no power of them.
PATHS = """
[[path]]
name = "delta = 0.2"
delta = 0.2
N = [128, 256, 512]
source = "local"

[[path]]
name = "delta = 12h"
delta = "12*h"
N = [256, 512]
source = "local"
"""
PHASES = ("positions_seconds", "weights_seconds", "pairs_seconds", "source_seconds")


class BenchTest(ProgramTest):
    def bench(self, text, *arguments, expect=0):
        self.write("tiny.toml", text)
        done = self.acstudy("bench", "tiny.toml", "--out", "out", *arguments)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def stored(self):
        return json.loads((self.folder / "out" / "bench.json").read_text(encoding="utf-8"))


class Bench(BenchTest):
    def test_every_case_has_its_runs_its_time_and_the_error_of_run(self):
        done = self.bench(STUDY, "--runs", "7", "--least-seconds", "0.02")
        self.assertRegex(done.stdout, r"\A3 cases, \d+ timed runs in \d+\.\d s; samples in out\n\Z")
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()), ["bench.h5", "bench.json"])
        bench = self.stored()
        self.assertTrue(bench["complete"])
        self.run_study(STUDY, out="run")
        expected = self.result(out="run")["series"][0]["cases"]
        self.assertEqual(bench["series"][0]["cases"], [0, 1, 2])
        for case, of_run in zip(bench["cases"], expected, strict=True):
            for name in ("N", "h", "delta", "dt", "steps", "error_linf", "work"):
                self.assertEqual(case[name], of_run[name], name)
            samples = case["samples"]
            self.assertGreaterEqual(len(samples["seconds"]), 7)
            self.assertGreaterEqual(sum(samples["seconds"]), 0.02)
            self.assertEqual(samples["round"], list(range(1, len(samples["round"]) + 1)))
            for name in ("seconds", *PHASES):
                values = np.array(samples[name])
                self.assertEqual(len(values), len(samples["round"]), name)
                self.assertAlmostEqual(case[name]["median"], np.median(values), delta=1e-15)
                self.assertEqual(case[name]["minimum"], values.min())
                self.assertAlmostEqual(case[name]["deviation"], np.median(abs(values - np.median(values))), delta=1e-15)
            parts = sum(np.array(samples[name]) for name in PHASES)
            self.assertTrue((parts <= np.array(samples["seconds"]) * (1 + 1e-9)).all())
            self.assertTrue((parts > 0).all())

    def test_both_files_hold_the_same(self):
        self.bench(STUDY, "--threads", "1,2", "--least-seconds", "0")
        bench = self.stored()
        with h5py.File(self.folder / "out" / "bench.h5") as file:
            self.assertEqual(file.attrs["format"].decode(), bench["format"])
            for name, value in bench["provenance"].items():
                self.assertEqual(file["provenance"].attrs[name].decode(), value, name)
            self.assertEqual(len(bench["cases"]), 6)
            for key, case in zip(sorted(file["cases"]), bench["cases"], strict=True):
                group = file["cases"][key]
                for name in ("N", "h", "delta", "dt", "steps", "threads", "error_linf"):
                    self.assertEqual(group.attrs[name], case[name], name)
                for name, count in case["work"].items():
                    self.assertEqual(group.attrs[f"work_{name}"], count, name)
                for name, values in case["samples"].items():
                    self.assertEqual(list(group[name]), values, name)
            for key, series in zip(sorted(file["series"]), bench["series"], strict=True):
                self.assertEqual(list(file["series"][key]["cases"]), series["cases"])
                self.assertEqual(file["series"][key].attrs["threads"], series["threads"])
        # Threads share the work of a case; they do not change it.
        for one, two in zip(bench["cases"][:3], bench["cases"][3:], strict=True):
            self.assertEqual((one["threads"], two["threads"]), (1, 2))
            self.assertEqual((one["error_linf"], one["work"]), (two["error_linf"], two["work"]))

    def test_a_finished_bench_has_nothing_to_do_until_more_is_asked_for(self):
        self.bench(STUDY, "--least-seconds", "0")
        first = self.stored()
        self.assertIn("3 cases, 0 timed runs", self.bench(STUDY, "--least-seconds", "0").stdout)
        self.assertEqual(self.bench(STUDY, "--least-seconds", "0", "--quiet").stdout, "")
        self.assertEqual(self.stored()["cases"], first["cases"])
        self.assertIn("3 cases, 6 timed runs", self.bench(STUDY, "--least-seconds", "0", "--runs", "7").stdout)
        for now, before in zip(self.stored()["cases"], first["cases"], strict=True):
            self.assertEqual(now["samples"]["seconds"][:5], before["samples"]["seconds"])
            self.assertEqual(now["samples"]["session"], [1] * 5 + [2] * 2)
        self.assertIn("3 cases, 15 timed runs", self.bench(STUDY, "--least-seconds", "0", "--fresh").stdout)

    def test_an_interrupted_bench_keeps_its_runs_and_goes_on(self):
        self.write("tiny.toml", STUDY)
        process = subprocess.Popen([ACSTUDY, "bench", "tiny.toml", "--out", "out", "--least-seconds", "3600"],
                                   cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130, out + err)
        self.assertIn("the same command goes on from them", err)
        bench = self.stored()
        self.assertFalse(bench["complete"])
        runs = [len(case["samples"]["seconds"]) for case in bench["cases"]]
        self.assertGreater(min(runs), 5)
        self.assertLessEqual(max(runs) - min(runs), 1)
        self.assertIn("3 cases, 0 timed runs", self.bench(STUDY, "--least-seconds", "0").stdout)
        self.assertEqual([len(case["samples"]["seconds"]) for case in self.stored()["cases"]], runs)

    def test_a_case_without_a_solution_is_said_and_not_timed(self):
        unstable = edit(STUDY, ('"h/4"', '"8*h"'), ("N = [16, 32, 64]", "N = [320, 640]"), ('"4*h"', '"h^2"'),
                        ('use = "lee-du-2019"', 'use = "lee-du-2019"\nT = 30'))
        done = self.bench(unstable, "--least-seconds", "0", expect=3)
        self.assertIn("acstudy: not timed, it has no solution: Model I", done.stderr)
        failures = [case["failure"] for case in self.stored()["cases"]]
        self.assertTrue(any(failures))
        for case, failure in zip(self.stored()["cases"], failures):
            self.assertEqual("samples" in case, not failure)

    def test_what_cannot_be_timed_is_refused_and_nothing_written(self):
        self.write("maps.toml", '[study]\nname = "judge"\nkind = "corpus"\n')
        self.assert_bad_input(self.acstudy("bench", "maps.toml", "--out", "out"),
                              'maps.toml: kind = "corpus"; bench times the runs of convergence studies, so leave it out')
        for arguments in (("--runs", "0"), ("--threads", "0"), ("--threads", "1,x"), ("--least-seconds", "-1"), ("--jobs", "2")):
            self.write("tiny.toml", STUDY)
            done = self.acstudy("bench", "tiny.toml", "--out", "out", *arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertIn("see acstudy bench --help", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_another_file_in_its_place_stops_it(self):
        self.run_study(STUDY, out="out")
        (self.folder / "out" / "tiny.h5").rename(self.folder / "out" / "bench.h5")
        self.assertRegex(self.bench(STUDY, expect=4).stderr,
                         r"\Aacstudy: out/bench.h5: not a readable bench \(.*\); remove it, or use --fresh\n\Z")
        self.bench(STUDY, "--fresh", "--least-seconds", "0")

    def test_help_says_what_it_takes(self):
        done = self.acstudy("bench", "--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for word in ("STUDY.toml", "--out", "reports/out/bench", "--runs", "--least-seconds", "--threads", "--fresh"):
            self.assertIn(word, done.stdout)


class WorkPrecision(BenchTest):
    def test_work_follows_N_squared_delta_over_h(self):
        """Of two models, as counted; half a neighbor per side is what rounding to whole ones takes away."""
        for text in (STUDY, edit(STUDY, MODEL_II)):
            text = text[:text.index("[[path]]")] + PATHS
            self.bench(text, "--runs", "1", "--least-seconds", "0", "--fresh")
            bench = bench_results.read_bench(self.folder / "out" / "bench.json")
            N, neighbors, pairs = (np.concatenate([of(curve) for curve in bench.curves]) for of in (
                lambda curve: curve.N, lambda curve: curve.neighbors - 0.5, lambda curve: curve.pairs))
            law = work_precision.fit_law(N, neighbors, pairs)
            self.assertAlmostEqual(law.a, 2, delta=0.05)
            self.assertAlmostEqual(law.b, 1, delta=0.05)
            self.assertLess(law.rms, 0.05)
            # Work that forgets the steps, or all but the nearest neighbors, is noticed.
            steps = np.concatenate([curve.steps for curve in bench.curves])
            self.assertGreater(abs(work_precision.fit_law(N, neighbors, pairs / steps).a - 2), 0.5)
            self.assertGreater(abs(work_precision.fit_law(N, neighbors, N * steps).b - 1), 0.5)

    def test_a_disturbed_machine_is_named_with_what_it_leaves_out(self):
        self.bench(edit(STUDY, ("[16, 32, 64]", str(list(range(16, 40, 2))))) + PATHS, "--runs", "1", "--least-seconds", "0")
        quiet = self.stored()
        (self.folder / "bench").mkdir()
        for deviation, missing in ((0.01, False), (0.3, True)):
            for case in quiet["cases"]:
                seconds = 1e-4 * case["N"] ** 2
                case["seconds"] = {"median": seconds, "minimum": seconds, "deviation": deviation * seconds}
            (self.folder / "bench" / "bench.json").write_text(json.dumps(quiet), encoding="utf-8")
            done = subprocess.run([sys.executable, ROOT / "reports" / "bench_tables.py", self.folder], text=True,
                                  capture_output=True, check=False, timeout=60)
            self.assertEqual(done.returncode, 0)
            for words in ("the machine was disturbed: 17 of 17 cases deviate from run to run by more than 5 %",
                          "left out of the law of cost: 1 of 1 schemes", "left out of the prices of work: 1 of 1 schemes"):
                self.assertEqual(words in done.stderr, missing, done.stderr)
            self.assertEqual("Law of cost" in done.stdout, not missing)
            self.assertIn("left out: threads; no bench has cases with one thread and with several", done.stderr)

    def test_the_studies_of_make_bench_are_sound(self):
        for study in sorted((ROOT / "studies" / "bench").glob("*.toml")):
            done = self.acstudy("explain", study)
            self.assertEqual((done.returncode, done.stderr), (0, ""), study)

    def test_the_coarse_twin_of_make_bench_prints_tables_and_draws(self):
        fine = edit(STUDY, ('"tiny"', '"fine"'), ("N = [16, 32, 64]", "N = [128]"))
        scaling = edit(STUDY, ('"tiny"', '"scaling-n"'))
        threads = edit(STUDY, ('"tiny"', '"scaling-threads"'), ("N = [16, 32, 64]", "N = [256]"))
        for name, text in (("tiny", STUDY), ("fine", fine), ("scaling", scaling), ("threads", threads)):
            self.write(f"{name}.toml", text)
        for arguments in (("tiny.toml", "fine.toml", "scaling.toml", "--out", "out/bench"),
                          ("threads.toml", "--threads", "1,2", "--out", "out/bench-threads")):
            self.assertEqual(self.acstudy("bench", *arguments, "--least-seconds", "0").returncode, 0)
        # So short cases have no law of cost, and that is said.
        for program, words, missing in (
                ("bench_tables.py", ("| Model I", "| 16 – 128 |", "not reached", "**Threads**"),
                 "bench_tables.py: left out of the law of cost: 1 of 1 schemes; they have fewer than five cases of 2 ms or "
                 "more with a deviation of 5 % at most\n"),
                ("report.py", ("out/index.html",), "")):
            done = subprocess.run([sys.executable, ROOT / "reports" / program, self.folder / "out"], text=True,
                                  capture_output=True, check=False, timeout=60)
            self.assertEqual(done.returncode, 0, program)
            self.assertTrue(done.stderr.startswith(missing) if missing else not done.stderr, done.stderr)
            for word in words:
                self.assertIn(word, done.stdout)
        page = (self.folder / "out" / "index.html").read_text(encoding="utf-8")
        for word in ('data-figure="bench.seconds', 'data-figure="bench.work"', 'data-figure="bench.parts"',
                     'data-figure="bench.scaling"', "Seconds to reach",
                     "Where the time goes", "bench-threads"):
            self.assertIn(word, page)


if __name__ == "__main__":
    unittest.main()
