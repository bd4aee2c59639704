"""The built program as a user meets it: what it runs, stores, reuses, leaves out, judges and says."""

import json
import math
import os
from pathlib import Path
import pty
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

from tests.program import ACSTUDY, FIELDS, MODEL_II, ROOT, STUDY, USE, ProgramTest, edit

LEVELS = "[16, 32, 64]"
SCENE = '"lee-du-2019"'
# Particles at rest in the flow of a smooth solution: first order from the coarsest level on.
GOOD = edit(STUDY, (SCENE, '"lagrangian"'), (LEVELS, "[32, 64, 128, 256]"))
# Both models, both divergences, all kernels, both sources, horizons above, at and below the spacing.
WIDE = STUDY[:STUDY.index("[[scheme]]")] + """\
[[scheme]]
model = 1
divergence = "local"
kernel = "inverse"

[[scheme]]
model = 1
divergence = "nonlocal"
kernel = { name = "power", alpha = 0.5 }

[[scheme]]
model = 2
divergence = "nonlocal"
kernel = "cubic-spline"
mu = 1.5

[time]
integrator = "ssprk2"
step = "h/4"

[[path]]
name = "delta = 4h"
delta = "4*h"
N = [16, 32, 64]
source = "local"

[[path]]
name = "delta = h^2"
delta = "h^2"
N = [16, 32]
source = "local"

[[path]]
name = "delta = 1"
delta = 1
N = [16, 32]
source = "nonlocal"
"""
CASES_OF_WIDE = 3 * (3 + 2 + 2)


def series_of(file):
    return [file["series"][name] for name in sorted(file["series"])]


def text_of(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else attribute


def numbers(path):
    """Everything in a result file but how long it took and where it was made, as bytes by name."""
    content = {}

    def visit(name, item):
        if name.startswith("provenance"):
            return
        for key, value in item.attrs.items():
            content[f"{name}@{key}"] = np.asarray(value).tobytes()
        if isinstance(item, h5py.Dataset) and "seconds" not in name and not name.endswith("repeats"):
            content[name] = item[()].tobytes()

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return content


class Results(ProgramTest):
    """What a run writes."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = Path(folder.name) / "out"
        study = Path(folder.name) / "tiny.toml"
        study.write_text(WIDE, encoding="utf-8")
        cls.done = subprocess.run([ACSTUDY, "run", study, "--out", cls.out, "--jobs", "2"], text=True,
                                  capture_output=True, check=False, timeout=60)
        cls.json_text = (cls.out / "tiny.json").read_text(encoding="utf-8")
        cls.json = json.loads(cls.json_text)

    def setUp(self):
        super().setUp()
        self.file = h5py.File(self.out / "tiny.h5", "r")
        self.addCleanup(self.file.close)
        self.pairs = list(zip(self.json["series"], series_of(self.file), strict=True))

    def test_a_study_becomes_two_files_and_a_line_per_series(self):
        self.assertEqual(sorted(file.name for file in self.out.iterdir()), ["tiny.h5", "tiny.json"])
        # Model II takes steps for which its lemma does not answer.
        for line in self.done.stderr.splitlines():
            self.assertRegex(line, "^acstudy: note: tiny: Model II, .* beyond the bound of Lemma 3.3, by a factor of up ")
        self.assertEqual(len(self.done.stdout.splitlines()), 1 + 9 + 1)
        self.assert_counts(self.done, CASES_OF_WIDE, 0)

    def test_every_promised_key_is_there(self):
        def check(value, shape, where):
            if isinstance(shape, dict):
                self.assertIsInstance(value, dict, where)
                self.assertLessEqual(shape.keys(), value.keys(), where)
                for key, inner in shape.items():
                    check(value[key], inner, f"{where}.{key}")
            elif isinstance(shape, list):
                self.assertIsInstance(value, list, where)
                for i, item in enumerate(value):
                    check(item, shape[0], f"{where}[{i}]")
            else:
                self.assertIsInstance(value, shape, where)
                self.assertFalse(isinstance(value, bool) and shape is not bool, where)

        real, real_or_none = (int, float), (int, float, type(None))
        check(self.json, {
            "study": str, "title": str, "provenance": dict, "series": [{
                "model": int, "divergence": str, "kernel": str, "path": str, "source": str,
                "theory": {"variable": str, "order": real, "statement": str},
                "observed": {"order": real_or_none, "low": real_or_none, "high": real_or_none,
                             "pairwise": [real_or_none]},
                "verdict": str, "expected": str, "as_expected": bool, "reason": str,
                "cases": [{"N": int, "h": real, "delta": real, "dt": real, "steps": int, "error_linf": real,
                           "error_l1": real, "error_l2": real, "seconds": real,
                           "work": {"pairs": int, "weight_builds": int, "quadrature_points": int}}]}]}, "")
        self.assertEqual((self.json["study"], self.json["title"]), ("tiny", "A tiny study"))
        self.assertEqual([len(series["cases"]) for series in self.json["series"]], [3, 2, 2] * 3)
        for key in ("version", "compiler", "flags", "machine", "system", "created", "command", "libraries"):
            self.assertTrue(self.json["provenance"][key], key)
        self.assertTrue(all(series["reason"] for series in self.json["series"]))

    def test_cases_are_those_of_the_study(self):
        for series in self.json["series"]:
            delta = {"delta = 4h": lambda h: 4 * h, "delta = h^2": lambda h: h * h,
                     "delta = 1": lambda h: 1.0}[series["path"]]
            for case, N in zip(series["cases"], (16, 32, 64)):
                h = 2 * math.pi / N
                steps = math.ceil(1 / (h / 4))
                self.assertEqual((case["N"], case["steps"], case["h"]), (N, steps, h))
                self.assertAlmostEqual(case["delta"], delta(h), delta=1e-15)
                self.assertAlmostEqual(case["dt"], 1 / steps, delta=1e-16)

    def test_json_and_hdf5_agree_number_by_number(self):
        def equal(in_json, in_h5, where):
            in_h5 = text_of(in_h5)
            if in_json is None:
                self.assertTrue(math.isnan(in_h5), where)
            else:
                self.assertEqual(in_json, in_h5, where)

        for name, value in self.json["provenance"].items():
            equal(value, self.file["provenance"].attrs[name], name)
        equal(WIDE, self.file.attrs["study_text"], "study_text")
        for series, group in self.pairs:
            renamed = {"delta": "delta_text", "step": "step_text"}
            for key, value in series.items():
                if key not in ("theory", "observed", "cases"):
                    equal(value, group.attrs[renamed.get(key, key)], key)
            for key, value in series["theory"].items():
                equal(value, group.attrs[f"theory_{key}"], key)
            for key, value in series["observed"].items():
                if key == "extrapolated":
                    equal(value, group.attrs["extrapolated_order"], key)
                elif key != "pairwise":
                    equal(value, group.attrs[f"observed_{key}"], key)
            self.assertEqual(series["observed"]["pairwise"], list(group["pairwise"]))
            flat = [{key: value for key, value in case.items() if key not in ("work", "bound")} |
                    {f"{part}_{key}": value for part in ("work", "bound") for key, value in case[part].items()}
                    for case in series["cases"]]
            for key in flat[0]:
                self.assertEqual([case[key] for case in flat], list(group[key]), key)
            self.assertEqual(sorted(group["cases"], key=int), [str(case["N"]) for case in flat])

    def test_json_numbers_have_17_significant_digits(self):
        texts = []
        json.loads(self.json_text, parse_float=texts.append)
        self.assertGreater(len(texts), 100)
        for text in texts:
            self.assertEqual(text, format(float(text), ".17g"))

    def test_errors_are_the_norms_of_the_stored_fields(self):
        period = 2 * math.pi
        for series, group in self.pairs:
            for case in series["cases"]:
                stored = group["cases"][str(case["N"])]
                x, u, u_exact = (stored[name][()] for name in ("x", "u", "u_exact"))
                self.assertEqual(x.shape, (case["N"],))
                error = np.abs(u - u_exact)
                width = (np.append(x[1:], x[0] + period) - np.insert(x[:-1], 0, x[-1] - period)) / 2
                self.assertAlmostEqual(width.sum(), period, delta=1e-12)
                self.assertEqual(case["error_linf"], error.max())
                self.assertAlmostEqual(case["error_l1"] / ((width * error).sum() / period), 1, delta=1e-12)
                self.assertAlmostEqual(case["error_l2"] / math.sqrt((width * error**2).sum() / period), 1, delta=1e-12)

    def test_stored_positions_and_solutions_are_those_of_the_scene(self):
        for series, group in self.pairs:
            for case in series["cases"]:
                stored = group["cases"][str(case["N"])]
                x, u_exact = stored["x"][()], stored["u_exact"][()]
                start = 2 * math.pi * np.arange(case["N"]) / case["N"]
                flow = 2 * np.arctan2(np.sin(start / 2) * math.e, np.cos(start / 2))
                # A few units in the last place of numbers up to 2 pi.
                np.testing.assert_allclose(x, flow, rtol=0, atol=4e-15)
                np.testing.assert_allclose(u_exact, np.cos(x - 1), rtol=0, atol=4e-15)

    def test_a_scene_that_ends_where_it_starts_takes_no_step_and_has_no_error(self):
        for changes in ((), (MODEL_II,), (('"h/4"', '"cfl"'),)):
            with self.subTest(changes):
                # No error has no order either.
                done = self.run_study(edit(STUDY, (USE, USE + "\nT = 0"), *changes), "--fresh", expect=1)
                self.assertIn("floor, expected confirmed: the finest error, 0, is round-off", done.stdout)
                for case in self.result()["series"][0]["cases"]:
                    self.assertEqual([case[key] for key in ("steps", "dt", "error_linf", "error_l1", "error_l2")],
                                     [0] * 5)

    def test_inline_fields_give_the_errors_of_the_named_scene(self):
        def errors(text):
            self.run_study(text, "--fresh")
            return np.array([[case["error_linf"], case["error_l1"], case["error_l2"]]
                             for series in self.result()["series"] for case in series["cases"]])

        named = np.array([[case["error_linf"], case["error_l1"], case["error_l2"]]
                          for series in self.json["series"] for case in series["cases"]])
        inline = edit(WIDE, (USE, FIELDS))
        np.testing.assert_allclose(errors(inline), named, rtol=1e-11)
        # The flow integrated to round-off; errors are differences of numbers of order one.
        without_flow = edit(inline, (FIELDS.splitlines()[-1] + "\n", ""))
        np.testing.assert_allclose(errors(without_flow), named, rtol=1e-11)
        other = edit(inline, ('"cos(2*x)/3"', '"cos(2*x)/3.001"'))
        self.assertGreater(np.max(np.abs(errors(other) / named - 1)), 1e-6)

    def test_numbers_do_not_depend_on_the_jobs(self):
        self.run_study(WIDE, "--jobs", "1")
        self.assertEqual((self.result()["provenance"]["jobs"], self.json["provenance"]["jobs"]), ("1", "2"))
        one, two = numbers(self.folder / "out" / "tiny.h5"), numbers(self.out / "tiny.h5")
        self.assertEqual(one, two)
        self.assertTrue(any(name.endswith("/u") for name in one))
        self.assertTrue(any(name.endswith("/work_pairs") for name in one))
        # The comparison sees a change in the tenth digit of one input.
        self.assert_counts(self.run_study(edit(WIDE, ("mu = 1.5", "mu = 1.5000000001"))), 7, 14)
        changed = numbers(self.folder / "out" / "tiny.h5")
        self.assertEqual({name for name in one if name.endswith("/u") and one[name] != changed[name]},
                         {name for name in one if re.fullmatch(r"series/00[678]/cases/\d+/u", name)})


class Reuse(ProgramTest):
    """What is not run again."""

    def stored(self, out="out"):
        return numbers(self.folder / out / "tiny.h5")

    def test_a_second_run_computes_nothing_and_changes_nothing(self):
        self.assert_counts(self.run_study(WIDE, "--jobs", "1"), CASES_OF_WIDE, 0)
        first, result = self.stored(), self.result()
        self.assert_counts(self.run_study(WIDE, "--jobs", "2"), 0, CASES_OF_WIDE)
        self.assertEqual(self.stored(), first)
        # The seconds and the provenance are still those of the first run.
        self.assertEqual(self.result(), result)
        self.assert_counts(self.run_study(WIDE, "--jobs", "2", "--fresh"), CASES_OF_WIDE, 0)
        self.assertEqual(self.stored(), first)
        self.assertEqual(self.result()["provenance"]["jobs"], "2")

    def test_words_that_change_no_number_compute_nothing(self):
        self.run_study(STUDY)
        for change in (('"A tiny study"', '"Another title"'), ('name = "delta = 4h"', 'name = "another"'),
                       ('source = "local"', 'source = "local"\nexpect = "above"'),
                       ('source = "local"', 'source = "local"\norder = 2'), ('delta = "4*h"', 'delta = "h*4"')):
            with self.subTest(change):
                self.assert_counts(self.run_study(edit(STUDY, change)), 0, 3)

    def test_a_new_level_computes_that_level(self):
        self.run_study(edit(STUDY, (LEVELS, "[16, 64]")))
        first = self.result()["series"][0]["cases"]
        self.assert_counts(self.run_study(STUDY), 1, 2)
        cases = self.result()["series"][0]["cases"]
        self.assertEqual([case["N"] for case in cases], [16, 32, 64])
        self.assertEqual([cases[0], cases[2]], first)

    def test_whatever_changes_a_number_is_computed(self):
        base = edit(STUDY, MODEL_II, ('step = "h/4"', 'step = "h/8"'))
        kernel = ('kernel = "cubic-spline"', 'kernel = { name = "power", alpha = 0.5 }')
        for first, change in ((base, ('kernel = "cubic-spline"', 'kernel = "cubic-spline"\nmu = 1.5')),
                              (base, ('"h/8"', '"h/9"')),
                              (base, ("forward-euler", "ssprk2")),
                              (base, ('divergence = "local"', 'divergence = "nonlocal"')),
                              (base, ('source = "local"', 'source = "nonlocal"')),
                              (base, ("4*h", "3*h")),
                              (base, (USE, USE + "\nT = 1.5")),
                              (base, kernel),
                              (base, ("model = 2", "model = 1")),
                              (edit(base, kernel), ("alpha = 0.5", "alpha = 0.25")),
                              (edit(base, (USE, FIELDS)), ("cos(2*x)/3", "cos(2*x)/4"))):
            with self.subTest(change):
                self.run_study(first, "--fresh")
                before = [case["error_linf"] for case in self.result()["series"][0]["cases"]]
                self.assert_counts(self.run_study(edit(first, change)), 3, 0)
                after = [case["error_linf"] for case in self.result()["series"][0]["cases"]]
                self.assertTrue(all(a != b for a, b in zip(before, after)))

    def test_studies_share_their_cases(self):
        self.write("one.toml", edit(STUDY, ('"tiny"', '"one"')))
        self.write("two.toml", edit(STUDY, ('"tiny"', '"two"'), (LEVELS, "[16, 32, 64, 128]")))
        self.assert_counts(self.acstudy("run", "one.toml", "two.toml", "--out", "out"), 4, 0)
        one, two = (self.result(name)["series"][0]["cases"] for name in ("one", "two"))
        self.assertEqual(one, two[:3])
        self.assert_counts(self.acstudy("run", "two.toml", "one.toml", "--out", "out"), 0, 7)


class Interruption(ProgramTest):
    # About 5 s: a short case is repeated for a tenth of a second. Some are finished and many are not when the signal
    # comes.
    MANY = str(list(range(300, 350)))
    LONG = edit(STUDY, ("4*h", "0.5"), (LEVELS, MANY), ('source = "local"', 'source = "nonlocal"'))

    MAP = STUDY[:STUDY.index("[[path]]")].replace('title = "A tiny study"', 'kind = "map"') + """\
[map]
delta = [0.04, 0.16, 0.4, 0.6]
N = [57, 80, 113, 160]
sources = ["local"]
"""

    def start(self, *arguments):
        """Starts a run whose stderr is a terminal; (process, function that reads the terminal)."""
        try:
            ours, theirs = pty.openpty()
        except OSError as error:  # a bare chroot has no /dev/pts
            self.skipTest(f"no pseudo-terminal here: {error}")
        self.addCleanup(os.close, ours)
        process = subprocess.Popen([ACSTUDY, "run", "tiny.toml", "--out", "out", *arguments], cwd=self.folder,
                                   text=True, stdout=subprocess.PIPE, stderr=theirs)
        os.close(theirs)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

        def read():
            try:
                return os.read(ours, 65536).decode()
            except OSError:  # closed by the program's end
                return ""

        return process, read

    def test_finished_cases_are_kept_and_the_next_run_goes_on(self):
        self.write("tiny.toml", self.LONG)
        process, read = self.start("--jobs", "1")
        said = ""
        while "3 of 50 cases" not in said:
            said += (new := read())
            self.assertTrue(new, said)
        process.send_signal(signal.SIGINT)
        sent = time.monotonic()
        out, _ = process.communicate(timeout=30)
        # A case is left between two time steps, here of about a millisecond.
        self.assertLess(time.monotonic() - sent, 2)
        while new := read():
            said += new
        self.assertEqual(process.returncode, 130)
        self.assertIn("acstudy: interrupted; finished cases are stored, and the same command goes on from them", said)
        self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])

        finished = int(re.search(r"(\d+) cases computed", out)[1])
        self.assertTrue(3 <= finished < 50, out)
        series, = self.result()["series"]
        self.assertEqual((len(series["cases"]), series["cases_planned"]), (finished, 50))
        with h5py.File(self.folder / "out" / "tiny.h5", "r") as file:
            self.assertEqual(len(series_of(file)[0]["cases"]), finished)
        checked = self.acstudy("check", "out/tiny.json")
        self.assertEqual(checked.returncode, 1)
        self.assertIn(f"{finished} of 50 cases; the run was interrupted", checked.stdout)

        # One more level instead of all that are left, to save time.
        kept = [case["N"] for case in series["cases"]]
        again = self.run_study(edit(self.LONG, (self.MANY, str([100, *kept]))))
        self.assert_counts(again, 1, finished)
        self.assertEqual(self.result()["series"][0]["cases"][1:], series["cases"])

    def test_a_run_ended_before_any_case_leaves_readable_files(self):
        self.write("tiny.toml", edit(self.LONG, (self.MANY, "[2000, 4000, 8000]")))
        process, _ = self.start()
        while not (self.folder / "out").exists():
            time.sleep(0.01)
        time.sleep(0.1)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])
        self.assertEqual(self.result()["series"][0]["cases"], [])
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)

    def test_the_terminal_shows_progress_and_is_left_clean(self):
        self.write("tiny.toml", GOOD)
        process, read = self.start()
        process.communicate(timeout=30)
        said = ""
        while new := read():
            said += new
        self.assertEqual(process.returncode, 0)
        self.assertRegex(said, r"1 of 4 cases, \d+ s, about \d+ s left")
        self.assertIn("4 of 4 cases", said)
        self.assertTrue(said.endswith("\r\033[K"), repr(said))

    def test_the_terminal_counts_cases_and_findings_and_shows_them_at_once(self):
        text = (ROOT / "studies" / "consistency.toml").read_text(encoding="utf-8")
        self.write("tiny.toml", edit(text, ('name = "consistency"', 'name = "tiny"')))
        process, read = self.start()
        said = ""
        while ", 2 s" not in said:
            said += (new := read())
            self.assertTrue(new, said)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
        # The line is there before anything is done, and every second from then on.
        self.assertRegex(said, r"\A\r\033\[K0 of \d+ findings, 0 s\r")
        self.assertIn(" findings, 1 s", said)
        # Of what is left nothing is said before the first is there.
        for line in said.split("\r\033[K"):
            if line.startswith("0 of"):
                self.assertNotIn("left", line)
        self.write("tiny.toml", self.MAP)
        process, read = self.start("--fresh")
        process.communicate(timeout=30)
        said = ""
        while new := read():
            said += new
        self.assertRegex(said, r"\A\r\033\[K0 of 16 cases and 0 of \d+ findings, 0 s\r")
        self.assertRegex(said, r"8 of 16 cases and 0 of \d+ findings, \d+ s, about \d+ s left for the cases")
        self.assertRegex(said, r"16 of 16 cases and 0 of \d+ findings, \d+ s\r")
        self.assertRegex(said, r"16 of 16 cases and 1 of \d+ findings, \d+ s, about \d+ s left\r")

    def test_without_a_terminal_a_good_run_says_nothing(self):
        done = self.run_study(GOOD, expect=0)
        self.assertEqual(done.stderr, "")


class LeftOut(ProgramTest):
    """What a study does not need is not computed, and explain says so."""

    STANDING = edit(STUDY, (SCENE, '"standing-variable-velocity"'))

    def cases(self, text):
        self.run_study(text, "--fresh")
        return [case for series in self.result()["series"] for case in series["cases"]]

    def explain(self, text):
        self.write("tiny.toml", text)
        before = sorted(os.listdir(self.folder))
        done = self.acstudy("explain", "tiny.toml")
        self.assertEqual((done.returncode, done.stderr, sorted(os.listdir(self.folder))), (0, "", before))
        return done.stdout

    def test_standing_particles_have_one_set_of_weights_and_no_flow(self):
        for text in (self.STANDING, edit(self.STANDING, MODEL_II, ('"h/4"', '"h/8"'), ("forward-euler", "ssprk3")),
                     edit(self.STANDING, ('divergence = "local"\n', ""))):
            for case in self.cases(text):
                self.assertGreater(case["steps"], 1)
                self.assertEqual((case["work"]["weight_builds"], case["work"]["flow_evaluations"]), (1, 0))
        said = self.explain(self.STANDING)
        self.assertIn("particle motion", said)
        self.assertIn("weight_builds = 1", said)

    def test_moving_particles_have_both_anew_at_every_stage(self):
        # The second stage of SSPRK2 stands where the next step starts, and the first place is the start.
        for integrator, places in (("forward-euler", 1), ("ssprk2", 1), ("ssprk3", 2)):
            for case in self.cases(edit(STUDY, ("forward-euler", integrator))):
                self.assertGreaterEqual(case["work"]["weight_builds"], places * case["steps"])
                self.assertGreaterEqual(case["work"]["flow_evaluations"], places * case["N"] * (case["steps"] - 1))
        self.assertNotIn("particle motion", self.explain(STUDY))

    def test_a_local_source_needs_no_quadrature(self):
        nonlocal_source = edit(STUDY, ('source = "local"', 'source = "nonlocal"'))
        for case in self.cases(STUDY):
            self.assertEqual(case["work"]["quadrature_points"], 0)
        for case in self.cases(nonlocal_source):
            self.assertGreater(case["work"]["quadrature_points"], case["N"] * case["steps"])
        self.assertIn("quadrature_points = 0", self.explain(STUDY))
        self.assertNotIn("quadrature_points = 0", self.explain(nonlocal_source))

    def test_a_horizon_below_the_spacing_leaves_the_nearest_neighbors(self):
        # Below every gap: particles approach each other by a factor e at most.
        below = ("4*h", "h^2/8")
        for integrator, stages in (("forward-euler", 1), ("ssprk2", 2), ("ssprk3", 3)):
            one = edit(STUDY, below, ("forward-euler", integrator))
            two = edit(one, MODEL_II)
            for text, sides in ((one, 1), (two, 2)):
                for case in self.cases(text):
                    self.assertEqual(case["work"]["pairs"], sides * case["N"] * stages * case["steps"])
        self.assertIn("1 in Model I, 2 in Model II", self.explain(edit(STUDY, below)))
        self.assertNotIn("1 in Model I, 2 in Model II", self.explain(STUDY))

    def test_explain_names_every_case_and_nothing_that_is_not_left_out(self):
        full = edit(STUDY, MODEL_II, ("forward-euler", "ssprk2"), ('source = "local"', 'source = "nonlocal"'))
        said = self.explain(full)
        self.assertTrue(said.endswith("left out, because nothing here needs it:\n  - nothing\n"), said)
        for words in ("tiny - A tiny study", "lee-du-2019", "cos(2*x)/3", "sin(x)", "ssprk2", "step h/4", "delta = 4h",
                      "source nonlocal", "mu = 1.33333", "1 series, 3 cases"):
            self.assertIn(words, said)
        self.assertEqual([int(row.split()[0]) for row in said.splitlines() if re.match(r" +\d+ ", row)], [16, 32, 64])
        self.assertIn("viscosity and midpoint velocities in Model I", self.explain(STUDY))
        self.assertNotIn("viscosity", said)
        self.assertIn("stage storage", self.explain(STUDY))

    def test_explain_counts_the_series_and_cases_of_every_study(self):
        self.assertIn(f"9 series, {CASES_OF_WIDE} cases", self.explain(WIDE))
        for study in sorted((ROOT / "studies").glob("*.toml")):
            done = self.acstudy("explain", study)
            self.assertEqual((done.returncode, done.stderr), (0, ""), study)

    def test_explain_warns_of_steps_and_viscosity_beyond_the_lemmas(self):
        self.assertIn("beyond the bound 1 of the stability lemma", self.explain(edit(STUDY, ('"h/4"', '"h"'))))
        self.assertNotIn("beyond", self.explain(STUDY))
        self.assertIn("Lemma 3.3 does not promise stability", self.explain(
            edit(STUDY, MODEL_II, ('"cubic-spline"', '"cubic-spline"\nmu = 1'))))


class Gate(ProgramTest):
    """check and the exit codes of run."""

    GOOD_SERIES = "Model I, local divergence, inverse, delta = 4h"
    # Beyond the CFL bound by a factor of about 6, with enough steps to blow up.
    UNSTABLE = edit(STUDY, ('"h/4"', '"5*h"'), (LEVELS, "[320, 640, 1280]"))
    # A viscosity at which one step multiplies the shortest wave by hundreds: past the largest number long before T.
    OVERFLOWING = edit(STUDY, MODEL_II, ('"cubic-spline"', '"cubic-spline"\nmu = 1000'), (LEVELS, "[320, 640, 1280]"))

    def tampered(self, change):
        """Runs check on a good result with a change made to its first series."""
        self.run_study(GOOD, expect=0)
        result = self.result()
        change(result["series"][0])
        self.write("tampered.json", json.dumps(result))
        return self.acstudy("check", "tampered.json")

    def test_good_results_pass(self):
        done = self.tampered(lambda series: None)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, rf"\Agate .*\nok +tiny +{self.GOOD_SERIES} .* confirmed *\n"
                                      r"1 gates, 0 depart\n\Z")

    def test_nothing_bad_passes(self):
        def error(level, change):
            def apply(series):
                case = series["cases"][level]
                case["error_linf"] = change(case["error_linf"])
            return apply

        def drop(count):
            return lambda series: series["cases"].__delitem__(slice(0, count))

        def drop_all_traces(count):
            def apply(series):
                del series["cases"][:count]
                series["cases_planned"] -= count
            return apply

        for what, change in {
                "an error is not a number": error(1, lambda e: None),
                "the finest error is not a number": error(-1, lambda e: None),
                "an error in the middle is inflated": error(2, lambda e: 3 * e),
                "the finest error is inflated": error(-1, lambda e: 1.2 * e),
                "the finest error is too good": error(-1, lambda e: e / 2),
                "one huge error at the finest level": error(-1, lambda e: 1e30),
                "a negative error": error(0, lambda e: -e),
                "an error of zero": error(1, lambda e: 0.0),
                "all errors equal": lambda series: [case.update(error_linf=0.1) for case in series["cases"]],
                "one level is missing": drop(1),
                "two levels are missing, and nothing says so": drop_all_traces(2),
                "no level is left": drop_all_traces(4),
                "the levels are in disorder": lambda series: series["cases"].reverse(),
                "the verdict is another": lambda series: series.update(verdict="above"),
                "the verdict is none": lambda series: series.update(verdict="excellent"),
                "another verdict is expected": lambda series: series.update(expected="above"),
                "theory has another order": lambda series: series["theory"].update(order=2.0)}.items():
            with self.subTest(what):
                done = self.tampered(change)
                self.assertEqual((done.returncode, done.stderr), (1, ""), done.stdout)
                self.assertRegex(done.stdout, rf"\Agate .*\nDEPART +tiny +{self.GOOD_SERIES} ")
                self.assertIn("1 gates, 1 depart", done.stdout)

    def test_one_bad_file_of_several_fails(self):
        self.run_study(GOOD, expect=0)
        self.run_study(edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "above"')), out="other", expect=1)
        for files in (("out/tiny.json", "other/tiny.json"), ("other/tiny.json", "out/tiny.json")):
            done = self.acstudy("check", *files)
            self.assertEqual(done.returncode, 1)
            self.assertIn("2 gates, 1 depart", done.stdout)

    def test_run_and_check_agree_on_a_wrong_expectation(self):
        text = edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "above"'))
        done = self.run_study(text, expect=1)
        self.assertRegex(done.stdout, r"DEPART .* confirmed, expected above")
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)
        self.run_study(text, expect=1)

    def test_a_blow_up_is_3_unless_it_is_expected(self):
        for text in (self.UNSTABLE, self.OVERFLOWING):
            done = self.run_study(text, expect=3)
            self.assertRegex(done.stdout, r"DEPART .* unstable, expected confirmed: ")
            self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)
            expected = edit(text, ('source = "local"', 'source = "local"\nexpect = "unstable"'))
            self.assert_counts(self.run_study(expected, expect=0), 0, 3)
            self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 0)

    def test_errors_of_a_run_that_overflowed_are_null(self):
        self.run_study(self.OVERFLOWING, expect=3)
        series, = self.result()["series"]
        for case in series["cases"]:
            self.assertIsNone(case["error_linf"])
            self.assertIn("the solution has grown to", case["blow_up"])
        self.assertEqual(series["observed"]["pairwise"], [None, None])
        self.assertEqual(series["verdict"], "unstable")

    def test_steps_beyond_the_bound_are_noted_and_judged_by_what_happens(self):
        # Gaps close like exp(-t): h/4 keeps the bound until t = log 3.
        done = self.run_study(edit(STUDY, (USE, USE + "\nT = 1.5"), ('"h/4"', '"h/4"\nexpect = "stable"')), expect=0)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertRegex(done.stderr, r"acstudy: note: tiny: Model I, local divergence, inverse, delta = 4h, N = 64: "
                                      r"from step \d+ on \(t = 1\.\d+, smallest gap at x = 3\.\d+\) steps are beyond "
                                      r"the bound of Lemma 2\.4, by a factor of up to 1\.\d+\n")
        for case in self.result()["series"][0]["cases"]:
            self.assertGreater(case["bound"]["largest"], 1.25)
            self.assertAlmostEqual(case["bound"]["first_time"], math.log(3), delta=0.2)

    def test_stable_expects_no_order_but_a_bounded_solution(self):
        stable = ('source = "local"', 'source = "local"\nexpect = "stable"')
        self.run_study(edit(GOOD, stable), expect=0)
        self.run_study(edit(self.UNSTABLE, stable), expect=3)
        case = self.result()["series"][0]["cases"][-1]
        last, steps = case["last"], case["steps"]
        self.assertIsNone(case["error_linf"])
        self.assertEqual(last["step"], steps)
        self.assertLess(last["time"], 1)
        self.assertGreater(last["error_linf"], 1e5)
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)

    def test_a_map_whose_runs_blow_up_fails_numerically(self):
        unstable = edit(STUDY[:STUDY.index("[[path]]")], ('name = "tiny"', 'name = "tiny"\nkind = "map"'), ('"h/4"', '"3*h"'))
        done = self.run_study(unstable + '[map]\ndelta = [0.001, 0.002, 0.004, 0.008]\nN = [160, 320, 640, 1280]\n'
                                         'sources = ["local"]\n', expect=3)
        self.assertIn("unstable, expected confirmed", done.stdout)

    def test_stable_is_no_error_of_many_times_the_solution(self):
        # Beyond the bound for a few steps: too few to blow up, enough to be of no use.
        few = edit(STUDY, ('"h/4"', '"3*h"'), ('"4*h"', '"h^2"'), (LEVELS, "[80, 120]"),
                   ('source = "local"', 'source = "local"\nexpect = "stable"'))
        self.run_study(few, expect=0)
        data = self.result()
        for case in data["series"][0]["cases"]:
            self.assertAlmostEqual(case["solution_linf"], 1, delta=0.01)
        data["series"][0]["cases"][1]["error_linf"] = 101.0
        self.write("out/tiny.json", json.dumps(data))
        checked = self.acstudy("check", "out/tiny.json")
        self.assertEqual(checked.returncode, 1)
        self.assertIn("an error is 101, that of a solution of 1 at most", checked.stdout)

    def test_each_way_to_step_is_a_series_with_its_own_expectation(self):
        moving = edit(STUDY, ('kernel = "inverse"', 'kernel = "cubic-spline"'), ('"4*h"', '"h^2"'),
                      (LEVELS, "[80, 160, 320, 640]"))
        ways = ('[time]\nintegrator = "forward-euler"\nstep = "h/4"',
                '[[time]]\nintegrator = "forward-euler"\nstep = "cfl"\nsafety = 0.5\n'
                '[[time]]\nintegrator = "sdirk2"\nstep = "h"\nexpect = "stable"')
        done = self.run_study(edit(moving, ways), expect=0)
        self.assertEqual(done.stderr, "")
        first, second = self.result()["series"]
        self.assertEqual((first["stepping"], first["expected"]), ("forward-euler, step 0.5 cfl", "confirmed"))
        self.assertEqual((second["stepping"], second["expected"]), ("sdirk2, step h", "stable"))
        for case in first["cases"]:
            self.assertLess(case["dt_smallest"], case["dt"])
            self.assertLessEqual(case["bound"]["largest"], 0.5 + 1e-12)
        checked = self.acstudy("check", "out/tiny.json")
        self.assertEqual(checked.returncode, 0, checked.stdout)
        self.assertIn("delta = 4h, sdirk2, step h ", checked.stdout)
        self.assert_counts(self.run_study(edit(moving, ways), expect=0), 0, 8)

    def test_unstable_expected_but_stable_departs(self):
        self.run_study(edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "unstable"')), expect=1)


class Machine(ProgramTest):
    """The machine fails: exit code 4, one line, no half file."""

    def assert_machine_failure(self, done, *words):
        self.assertEqual((done.returncode, done.stderr.count("\n")), (4, 1), done.stdout + done.stderr)
        self.assertTrue(done.stderr.startswith("acstudy: "), done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_a_result_file_that_cannot_be_read_is_kept_until_fresh(self):
        self.run_study(STUDY)
        file = self.folder / "out" / "tiny.h5"
        whole = file.read_bytes()
        wrong_format = bytearray(whole)
        at = whole.index(b"acstudy-1")
        wrong_format[at:at + 9] = b"acstudy-0"
        for what, content in {"truncated": whole[:len(whole) // 2], "empty": b"", "text": b"not HDF5\n" * 1000,
                              "another format": bytes(wrong_format)}.items():
            with self.subTest(what):
                file.write_bytes(content)
                done = self.run_study(STUDY)
                self.assert_machine_failure(done, "out/tiny.h5: not a readable result file",
                                            "remove it, or use --fresh")
                self.assertEqual((done.stdout, file.read_bytes()), ("", content))
                self.assert_counts(self.run_study(STUDY, "--fresh"), 3, 0)
                self.assert_counts(self.run_study(STUDY), 0, 3)

    def test_a_file_size_limit_leaves_the_old_results(self):
        self.run_study(STUDY)
        before = numbers(self.folder / "out" / "tiny.h5")
        for limit in (0, 2048, 12000):
            with self.subTest(limit):
                # Python ignores SIGXFSZ; the program shall too, and so see its write fail.
                done = self.run_study(edit(STUDY, (LEVELS, "[16, 32, 64, 128, 256]")), restore_signals=False,
                                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                self.assert_machine_failure(done, "tiny.h5")
                self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])
                self.assertEqual(numbers(self.folder / "out" / "tiny.h5"), before)

    def test_a_command_that_is_not_utf8_is_stored(self):
        study = os.fsencode(self.folder) + b"/\xff.toml"
        try:
            with open(study, "w", encoding="utf-8") as file:
                file.write(GOOD)
        except OSError as error:
            self.skipTest(f"this file system has no such names: {error}")
        done = self.acstudy("run", "--out", "out", os.fsdecode(study))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("toml", self.result()["provenance"]["command"])

    def test_a_full_device(self):
        device = self.folder / "device"
        device.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=32k", "none", device]
        if not shutil.which("mount") or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("mounting a small tmpfs needs privileges that this process does not have")
        self.addCleanup(subprocess.run, ["umount", device], check=True)
        done = self.run_study(edit(STUDY, (LEVELS, "[16, 32, 64, 128, 256, 512]")), out=device)
        self.assert_machine_failure(done, str(device))
        self.assertEqual(os.listdir(device), [])


class NotComputed(ProgramTest):
    """A case without a solution is no blow-up, and takes nothing else with it."""

    ROUGH = edit(STUDY, (USE, 'period = "2*pi"\nT = 1\nc = "1"\nu = "cos(400*x)"'), ('"4*h"', "2.5"),
                 ('source = "local"', 'source = "nonlocal"'))

    def test_it_is_inconclusive_and_exits_3_even_where_a_blow_up_is_expected(self):
        for text in (self.ROUGH, edit(self.ROUGH, ('"nonlocal"', '"nonlocal"\nexpect = "unstable"'))):
            done = self.run_study(text, "--fresh")
            self.assertEqual(done.returncode, 3, done.stdout)
            self.assertIn("inconclusive", done.stdout)
            self.assertIn("a case could not be computed: no Gauss rule", done.stdout)
            self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)

    def test_a_closed_stderr_changes_no_exit_code(self):
        done = subprocess.run(["sh", "-c", f"'{ACSTUDY}' run none.toml 2>&-"], cwd=self.folder)
        self.assertEqual(done.returncode, 2)


class Timing(ProgramTest):
    def test_repeats_is_the_least_number_of_timed_runs(self):
        self.run_study(STUDY, "--repeats", "7")
        for case in self.result()["series"][0]["cases"]:
            self.assertGreaterEqual(case["repeats"], 7)
            self.assertTrue(0 < case["seconds_low"] <= case["seconds"] <= case["seconds_high"])


class Readme(ProgramTest):
    """The README shows what the program prints."""

    def test_its_study_gives_the_output_it_shows(self):
        readme = (ROOT / "README.md").read_text(encoding="utf-8")
        study, = re.findall(r'```toml\n(\[study\]\nname = "first".*?)```', readme, re.S)
        shown = re.findall(r"```console\n\$ build/acstudy (.*?)\n(.*?)```", readme, re.S)
        self.assertEqual([command for command, _ in shown], ["explain first.toml", "run first.toml --out out",
                                                          "fit errors.csv --order 1",
                                                          "fit drag.csv --value drag --order 2"])
        self.write("first.toml", study)
        for name, table in re.findall(r"This is\s+`(\w+\.csv)`:\n\n```csv\n(.*?)```", readme, re.S):
            self.write(name, table)
        for command, output in shown:
            with self.subTest(command):
                self.assertEqual(self.acstudy(*command.split()).stdout, output)


class Words(ProgramTest):
    def test_version_help_and_list_need_nothing(self):
        done = self.acstudy("--version")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"\Aacstudy \d+\.\d+\.\d+\S*\n\Z")
        for arguments, words in ((("--help",), ("run", "check", "fit", "bench", "explain", "list", "--version", "Exit codes", "130")),
                                 (("run", "--help"), ("STUDY.toml", "--out", "reports/out", "--jobs", "--repeats", "--fresh")),
                                 (("check", "--help"), ("FILE.json", "exit 1")),
                                 (("fit", "--help"), ("TABLE.csv", "--variable", "--count", "--dimension", "--error", "--weight", "--levels",
                                                      "--order", "--scale", "--floor", "--value", "--difference", "--json")),
                                 (("explain", "--help"), ("STUDY.toml",)),
                                 (("list", "--help"), ("schemes", "kernels", "integrators", "scenes"))):
            done = self.acstudy(*arguments)
            self.assertEqual((done.returncode, done.stderr), (0, ""), arguments)
            for word in words:
                self.assertIn(word, done.stdout, arguments)
        self.assertEqual(os.listdir(self.folder), [])

    def test_what_list_names_can_be_written(self):
        names = {}
        for what in ("schemes", "kernels", "integrators", "scenes"):
            done = self.acstudy("list", what)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            names[what] = [re.split(r"  +", line)[0] for line in done.stdout.splitlines()]
            for line in done.stdout.splitlines():
                self.assertIn("  " + line, self.acstudy("list").stdout)
        self.assertEqual([len(names[what]) for what in ("schemes", "kernels")], [4, 3])
        studies = [edit(STUDY, ("model = 1\ndivergence = \"local\"", scheme.replace(", ", "\n")),
                        ('"inverse"', '"cubic-spline"')) for scheme in names["schemes"]]
        studies += [edit(STUDY, ('"inverse"', name.replace("alpha = A", "alpha = 0.5"))) for name in names["kernels"]]
        studies += [edit(STUDY, ('"forward-euler"', name)) for name in names["integrators"]]
        studies += [edit(STUDY, (SCENE, name)) for name in names["scenes"]]
        for text in studies:
            self.write("tiny.toml", text)
            done = self.acstudy("explain", "tiny.toml")
            self.assertEqual((done.returncode, done.stderr), (0, ""), text)

    def test_the_report_is_made_of_a_run(self):
        self.run_study(GOOD, expect=0)
        done = subprocess.run([sys.executable, ROOT / "reports" / "report.py", self.folder / "out"], text=True,
                              capture_output=True, check=False, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        html = (self.folder / "out" / "index.html").read_text(encoding="utf-8")
        for words in ("A tiny study", "confirmed", "delta = 4h", "tiny.svg"):
            self.assertIn(words, html)


if __name__ == "__main__":
    unittest.main()
