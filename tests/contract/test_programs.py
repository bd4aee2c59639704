"""A program as a scheme: what it is told, and what becomes of its answer."""

import json
import os
import signal
import subprocess
import time
import unittest

import numpy as np

from tests.outside_program import SOLVER, STUDY, Outside
from tests.program import ACSTUDY, edit


class Behavior(Outside):
    def test_good_answers_in_any_form_are_the_same(self):
        self.run_mode("good", expect=0)
        good = self.series()["cases"][2]
        for mode in ("file", "any order", "closes", "unread"):
            with self.subTest(mode):
                self.run_mode(mode, expect=0)
                case = self.series()["cases"][2]
                for error in ("error_linf", "error_l1", "error_l2"):
                    self.assertAlmostEqual(case[error], good[error], delta=1e-13)

    def test_a_command_of_several_lines_has_a_name_of_one(self):
        self.run_mode("good", ('label = "mine"\n', ""), ('["python3", "solver.py", "good"]',
                                                        r"""["python3", "-c", "import sys\nprint('{\"error_linf\": 1}')"]"""))
        self.assertEqual(self.series()["label"], "python3 -c import sys print('{\"error_linf\": 1}')")
        self.assertEqual([case["error_linf"] for case in self.series()["cases"]], [1] * 4)

    def test_errors_have_the_norms_of_other_schemes(self):
        self.run_mode("good", expect=0)
        case = self.series()["cases"][1]
        e = 0.1 * case["h"] * np.abs(np.cos(np.arange(32) * case["h"]))
        for name, value in (("error_linf", e.max()), ("error_l1", e.mean()), ("error_l2", np.sqrt((e * e).mean()))):
            self.assertAlmostEqual(case[name], value, delta=1e-14)
        self.assertEqual(self.series()["theory"], {"variable": "h", "order": 1.0, "statement": "given by the study"})
        self.assertEqual([self.series()[name] for name in ("model", "label", "command", "kernel", "divergence")],
                         [0, "mine", "python3 solver.py good", "", ""])

    def test_nothing_is_run_twice_until_a_file_changes(self):
        self.assert_counts(self.run_mode("good", expect=0), 4, 0)
        self.assert_counts(self.run_mode("good", expect=0), 0, 4)
        self.write("solver.py", SOLVER.replace("0.1 * h", "0.2 * h"))
        self.assert_counts(self.run_mode("good", expect=0), 4, 0)
        self.assertAlmostEqual(self.series()["cases"][0]["error_linf"], 0.2 * self.series()["cases"][0]["h"], delta=1e-12)
        self.assert_counts(self.run_mode("other", expect=0), 4, 0)

    def test_declared_inputs_are_of_the_key(self):
        self.write("table.txt", "1")
        inputs = ("order = 1\n", 'order = 1\ninputs = ["table.txt"]\n')
        self.assert_counts(self.run_mode("good", inputs, expect=0), 4, 0)
        self.assert_counts(self.run_mode("good", inputs, expect=0), 0, 4)
        self.write("table.txt", "2")
        self.assert_counts(self.run_mode("good", inputs, expect=0), 4, 0)

    def test_what_has_failed_is_tried_again(self):
        self.run_mode("exit 3", expect=3)
        self.assert_counts(self.run_mode("exit 3", expect=3), 1, 3)
        self.run_mode("nan", expect=3)
        self.assert_counts(self.run_mode("nan", expect=3), 0, 4)  # a solution, if no finite one

    def test_several_run_at_the_same_time(self):
        self.write("solver.py", SOLVER.replace("x, h, T =", "time.sleep(1); x, h, T ="))
        start = time.monotonic()
        self.run_mode("good", expect=0)
        alone = time.monotonic() - start
        start = time.monotonic()
        self.run_study(edit(STUDY, ("MODE", "good")), "--fresh", "--jobs", "4", env=self.environment, expect=0)
        self.assertLess(time.monotonic() - start, 0.75 * max(alone, 4))

    def test_seconds_are_those_of_the_process_or_what_it_says(self):
        self.write("solver.py", SOLVER.replace('else "good"', 'else time.sleep(0.2) or "good"'))
        self.run_mode("good", expect=0)
        self.assertGreater(self.series()["cases"][0]["seconds"], 0.2)
        self.write("solver.py", SOLVER.replace('"u": u}', '"u": u, "seconds": 1e-3 * len(x), "work": {"pairs": 7}}', 1))
        self.run_mode("good", expect=0)
        self.assertEqual([case["seconds"] for case in self.series()["cases"]], [0.016, 0.032, 0.064, 0.128])
        self.assertEqual([case["work"]["pairs"] for case in self.series()["cases"]], [7] * 4)

    def test_an_interruption_ends_the_programs(self):
        self.write("tiny.toml", edit(STUDY, ("MODE", "fork and hang"), ('"20 s"', '"10 min"')))
        with subprocess.Popen([ACSTUDY, "run", "tiny.toml", "--out", "out"], cwd=self.folder, env=self.environment,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
            for _ in range(400):
                if (self.folder / "child").exists() and (self.folder / "child").read_text():
                    break
                time.sleep(0.05)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(10), 130)
        self.assert_child_is_gone()

    def test_what_a_program_is_told(self):
        self.write("solver.py", 'import sys\nopen("told", "a").write(sys.stdin.read())\nprint(\'{"error_linf": 1}\')\n')
        moving = ('c = "1"\n', 'c = "1"\nb = "sin(x)"\n')
        timed = ("[[path]]", '[time]\nintegrator = "ssprk2"\nstep = "h/4"\n\n[[path]]')
        self.run_mode("good", moving, timed, ("[16, 32, 64, 128]", "[16]"), ("N =", 'delta = "2*h"\nN ='))
        told = json.loads((self.folder / "told").read_text())
        h = 2 * np.pi / 16
        self.assertEqual(told.pop("scene"), {"c": "1", "b": "sin(x)", "u": "sin(x - t)"})
        x, u0 = told.pop("x"), told.pop("u0")
        np.testing.assert_allclose(x, np.arange(16) * h, atol=1e-14)
        np.testing.assert_allclose(u0, np.sin(x), atol=1e-14)
        self.assertRegex(told.pop("case"), r"\A[0-9a-f]{16}\Z")
        self.assertEqual(told, {"path": "h alone", "source": "local", "period": 2 * np.pi, "T": 1, "N": 16, "h": h,
                                "delta": 2 * h, "dt": 1 / 11, "steps": 11})

    def test_many_particles_go_through_files(self):
        self.write("solver.py", """
import json, numpy, sys
case = json.load(sys.stdin)
assert "x" not in case
x, u = numpy.load(case["file"])
numpy.save(case["answer_file"], [x, numpy.sin(x - case["T"]) + case["h"]])
print(json.dumps({"file": case["answer_file"]}))
open("where", "w").write(case["file"])
""")
        self.run_mode("good", ("[16, 32, 64, 128]", "[100001, 200000, 400000]"))
        for case in self.series()["cases"]:
            self.assertAlmostEqual(case["error_linf"], case["h"], delta=1e-12)
        self.assertFalse(os.path.exists((self.folder / "where").read_text()))

    def test_a_fine_run_in_place_of_a_solution(self):
        unsolved = ('u = "sin(x - t)"', 'reference = "finest"\nu0 = "sin(x)"')
        self.run_mode("good", unsolved, ("[16, 32, 64, 128]", "[16, 32, 64, 128, 256]"), expect=0)
        self.assertEqual(self.series()["verdict"], "confirmed")
        self.write("solver.py", 'print(\'{"error_linf": 1}\')')
        self.run_mode("good", unsolved, expect=3)
        self.assertIn("gives errors, but no solution is known here", self.series()["cases"][0]["failure"])

    def test_beside_a_scheme_of_acstudy_on_one_path(self):
        both = edit(STUDY, ("MODE", "good"), ("[[path]]", '[[scheme]]\nmodel = 1\nkernel = "inverse"\n\n[time]\n'
                                              'integrator = "forward-euler"\nstep = "cfl"\nsafety = 0.5\n\n[[path]]'),
                    ("N =", 'delta = "2*h"\nN ='))
        self.run_study(both, "-v", env=self.environment, expect=0)
        mine, model = self.result()["series"]
        self.assertEqual([mine["label"], model["model"]], ["mine", 1])
        self.assertEqual(mine["theory"]["variable"], "max(h,delta)")
        self.assertEqual(mine["step"], "its own")
        done = self.acstudy("check", "out/tiny.json", "-v")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("mine, h alone", done.stdout)
        done = self.acstudy("compare", "out/tiny.json", "out/tiny.h5")
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)

    def test_a_right_scheme_and_one_with_a_mistake_are_told_apart(self):
        two = edit(STUDY, ("MODE", "good"), ("[[path]]", '[[scheme]]\nlabel = "wrong"\ncommand = ["python3", "wrong.py"]\n'
                                             'order = 1\nexpect = "stagnates"\n\n[[path]]'))
        self.write("wrong.py", SOLVER.replace("0.1 * h", "0.1").replace("sys.argv[1]", '"good"'))
        self.run_study(two, env=self.environment, expect=0)
        self.assertEqual([series["verdict"] for series in self.result()["series"]], ["confirmed", "stagnates"])

    def test_explain_names_the_command_and_its_files(self):
        self.write("tiny.toml", edit(STUDY, ("MODE", "good")))
        done = self.acstudy("explain", "tiny.toml")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("form: command\n  command: python3 solver.py good\n  timeout: 20 s\n  input: solver.py, checksum ",
                      done.stdout)
        self.assertIn("1 series, 4 cases", done.stdout)
        self.assertFalse((self.folder / "runs").exists())

    def test_a_bench_times_programs(self):
        self.write("tiny.toml", edit(STUDY, ("MODE", "good")))
        done = self.acstudy("bench", "tiny.toml", "--out", "out", "--runs", "2", "--least-seconds", "0",
                            env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        bench = json.loads((self.folder / "out" / "bench.json").read_text())
        self.assertEqual(len(bench["cases"]), 4)
        self.assertEqual(bench["series"][0]["label"], "mine")


if __name__ == "__main__":
    unittest.main()
