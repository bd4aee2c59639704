"""What a run writes, and the output that the README shows."""

import json
import math
from pathlib import Path
import re
import subprocess
import tempfile
import unittest

import h5py
import numpy as np

from tests.program import (ACSTUDY, CASES_OF_WIDE, FIELDS, MODEL_II, STUDY, USE, WIDE, ProgramTest, edit,
                           numbers, series_of, text_of)


class Results(ProgramTest):
    """What a run writes."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = Path(folder.name) / "out"
        study = Path(folder.name) / "tiny.toml"
        study.write_text(WIDE, encoding="utf-8")
        cls.done = subprocess.run([ACSTUDY, "run", "-v", study, "--out", cls.out, "--jobs", "2"], text=True,
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
        self.assertRegex(self.done.stderr, r"\A(acstudy: note: tiny: steps of \d of 9 series are beyond the bound of "
                                           r"Lemma 3\.3, by a factor of up to [^\n]+\n)?\Z")
        table = [line for line in self.done.stdout.splitlines() if re.match(r"(ok|DEPART) +tiny ", line)]
        self.assertEqual(len(table), 9)
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
            renamed = {"delta": "delta_text", "step": "step_text", "variable": "variable_name"}
            for key, value in series.items():
                if key not in ("theory", "observed", "cases", "coordinates"):
                    equal(value, group.attrs[renamed.get(key, key)], key)
            self.assertEqual(set(series["coordinates"]), set(group["coordinates"].attrs))
            for key, value in series["coordinates"].items():
                equal(value, group["coordinates"].attrs[key], key)
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
                done = self.run_study(edit(STUDY, (USE, USE + "\nT = 0"), *changes), "--fresh", "-v", expect=1)
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


if __name__ == "__main__":
    unittest.main()
