"""A program as a scheme: what it is told, what becomes of its answer, and of everything that it can do wrong."""

import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

import numpy as np

from tests.program import ACSTUDY, ProgramTest, edit

STUDY = """\
[study]
name = "tiny"

[scene]
period = "2*pi"
T = 1
c = "1"
u = "sin(x - t)"

[[scheme]]
label = "mine"
command = ["python3", "solver.py", "MODE"]
order = 1
timeout = "20 s"

[[path]]
name = "h alone"
N = [16, 32, 64, 128]
source = "local"
"""

# Of first order wherever it behaves; at N = 64 it does what its argument says.
SOLVER = r"""
import json, math, os, signal, subprocess, sys, time
case = json.load(sys.stdin)
mode = sys.argv[1] if case["N"] == 64 else "good"
with open("runs", "a") as runs: runs.write(f"{case['N']}\n")
x, h, T = case["x"], case["h"], case["T"]
u = [math.sin(a - T) + 0.1 * h * math.cos(a) for a in x]
answer = {"x": x, "u": u}
def give(text):
    sys.stdout.write(text)
    sys.stdout.flush()
if mode == "hang":
    time.sleep(600)
elif mode == "fork":        # a child of the same group that outlives it and keeps the pipes open
    subprocess.Popen([sys.executable, "-c", "import os, time; open('child', 'w').write(str(os.getpid())); time.sleep(600)"])
    while not os.path.exists("child") or not open("child").read(): time.sleep(0.01)
    give(json.dumps(answer))
elif mode == "fork and hang":
    subprocess.Popen([sys.executable, "-c", "import os, time; open('child', 'w').write(str(os.getpid())); time.sleep(600)"])
    time.sleep(600)
elif mode == "escape":      # one that leaves the group, floods stdout and is not waited for
    subprocess.Popen([sys.executable, "-c", "import os, time\nend = time.time() + 5\n"
                      "while time.time() < end: os.write(1, b' ' * 4096)"], start_new_session=True)
    give(json.dumps(answer))
elif mode == "much":
    block = b"x" * (1 << 20)
    for _ in range(1024): os.write(1, block)
elif mode == "much stderr":
    block = b"y" * (1 << 20)
    for _ in range(256): os.write(2, block)
    os.write(2, b"the end")
    give(json.dumps(answer))
elif mode == "exit 3":
    print("no more\nmemory \xff", file=sys.stderr)
    sys.exit(3)
elif mode == "signal":
    os.kill(os.getpid(), signal.SIGSEGV)
elif mode == "nan":
    u[5] = math.nan
    give(json.dumps(answer))
elif mode == "half":
    give(json.dumps(answer)[:500])
elif mode == "words":
    give("Solving ...\n" + json.dumps(answer))
elif mode == "nothing":
    pass
elif mode == "list":
    give("[1, 2]")
elif mode == "few":
    give(json.dumps({"x": x[:-1], "u": u[:-1]}))
elif mode == "few values":
    give(json.dumps({"x": x, "u": u[:-1]}))
elif mode == "twice":
    give(json.dumps({"x": [x[1], *x[1:]], "u": u}))
elif mode == "nan place":
    give(json.dumps({"x": [math.nan, *x[1:]], "u": u}))
elif mode == "text":
    give(json.dumps({"x": x, "u": ["1", *u[1:]]}))
elif mode == "other key":
    give(json.dumps({**answer, "error": 0}))
elif mode == "both":
    give(json.dumps({**answer, "error_linf": 0.1}))
elif mode == "negative":
    give(json.dumps({"error_linf": -0.1}))
elif mode == "no file":
    give(json.dumps({"file": "nothing.npy"}))
elif mode == "wrong file":
    import numpy
    numpy.save("wrong.npy", numpy.array([x, u], dtype=numpy.float32))
    give(json.dumps({"file": "wrong.npy"}))
elif mode == "closes":      # its streams, and goes on
    give(json.dumps(answer))
    os.close(1); os.close(2)
    time.sleep(0.3)
elif mode == "unread":
    give(json.dumps(answer))
elif mode == "file":
    import numpy
    numpy.save("right.npy", [x, u])
    give(json.dumps({"file": "right.npy"}))
elif mode == "any order":
    order = list(range(len(x)))[::-1]
    give(json.dumps({"x": [x[j] + 2 * math.pi * (j % 3 - 1) for j in order], "u": [u[j] for j in order]}))
else:
    give(json.dumps(answer))
"""


def alive(pid):
    try:
        os.kill(pid, 0)
        return True
    except ProcessLookupError:
        return False


class Outside(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("solver.py", SOLVER)
        python = self.folder / "bin" / "python3"
        python.parent.mkdir()
        python.symlink_to(sys.executable)
        self.environment = {**os.environ, "PATH": f"{python.parent}:{os.environ['PATH']}"}

    def run_mode(self, mode, *changes, **options):
        return self.run_study(edit(STUDY, ("MODE", mode), *changes), env=self.environment, **options)

    def series(self, number=0):
        return self.result()["series"][number]

    def assert_child_is_gone(self):
        child = int((self.folder / "child").read_text())
        for _ in range(100):
            if not alive(child):
                return
            time.sleep(0.05)
        os.kill(child, signal.SIGKILL)
        self.fail("a child of the program goes on")


class Misbehavior(Outside):
    def assert_one_case_fails(self, mode, reason, *changes):
        start = time.monotonic()
        done = self.run_mode(mode, *changes, expect=3)
        self.assertLess(time.monotonic() - start, 30)
        series = self.series()
        self.assertEqual([case["N"] for case in series["cases"]], [16, 32, 64, 128])
        for case in series["cases"]:
            if case["N"] == 64:
                self.assertRegex(case["failure"], f"N = 64: python3 solver.py {re.escape(mode)} {reason}")
                self.assertIsNone(case["error_linf"])
            else:
                self.assertNotIn("failure", case)
                self.assertAlmostEqual(case["error_linf"], 0.1 * case["h"], delta=1e-12)
        self.assertEqual(series["verdict"], "inconclusive")
        self.assertIn("N = 64", series["reason"])
        self.assertIn("mine, h alone", done.stdout)
        self.assertIn("N = 64", " ".join(done.stdout.split()))
        return series["cases"][2]

    def test_a_program_that_hangs_is_ended(self):
        self.assert_one_case_fails("hang", r"was ended after its timeout of 1 s", ('"20 s"', '"1 s"'))

    def test_its_children_end_with_it_although_they_hold_the_pipes(self):
        self.assert_one_case_fails("fork and hang", r"was ended after its timeout of 1 s", ('"20 s"', '"1 s"'))
        self.assert_child_is_gone()

    def test_a_child_that_outlives_its_parent_is_ended_and_the_answer_taken(self):
        start = time.monotonic()
        self.run_mode("fork", expect=0)
        self.assertLess(time.monotonic() - start, 15)
        self.assert_child_is_gone()
        self.assertEqual(self.series()["verdict"], "confirmed")

    def test_a_child_that_left_the_group_and_writes_on_is_not_waited_for(self):
        start = time.monotonic()
        self.run_mode("escape")
        self.assertLess(time.monotonic() - start, 4.5)

    def test_a_gigabyte_on_stdout(self):
        case = self.assert_one_case_fails("much", r"was ended after 16 MB on stdout")
        self.assertLess(len(case["failure"]), 1000)

    def test_much_on_stderr_is_read_and_its_end_kept(self):
        self.run_mode("much stderr", expect=0)
        self.assertTrue(self.series()["cases"][2]["stderr"].endswith("ythe end"))
        self.assertLessEqual(len(self.series()["cases"][2]["stderr"]), 2000)

    def test_exit_3_with_the_end_of_stderr(self):
        case = self.assert_one_case_fails("exit 3", r'ended with exit code 3; its stderr ends with "no more\\nmemory .*\\n"')
        self.assertIn("no more\nmemory", case["stderr"])

    def test_a_signal(self):
        self.assert_one_case_fails("signal", r"was ended by signal 11 \(Segmentation fault\)")

    def test_half_a_json(self):
        self.assert_one_case_fails("half", r'wrote 500 bytes to stdout that are not JSON from byte \d+ on, beginning with ')

    def test_words_before_the_json(self):
        self.assert_one_case_fails("words", r'wrote \d+ bytes to stdout that are not JSON from byte 1 on, beginning with '
                                   r'"Solving')

    def test_nothing(self):
        self.assert_one_case_fails("nothing", "wrote nothing to stdout")

    def test_no_object(self):
        self.assert_one_case_fails("list", "wrote JSON that is no object")

    def test_too_few_particles(self):
        self.assert_one_case_fails("few", "gives 63 values of x, and the case has N = 64 particles")
        self.assert_one_case_fails("few values", "gives 63 values of u, and the case has N = 64 particles")

    def test_particles_at_one_place(self):
        self.assert_one_case_fails("twice", r"gives two particles at x = 0\.09817")

    def test_a_place_that_is_none(self):
        self.assert_one_case_fails("nan place", r"gives no finite x\[0\]")

    def test_a_text_for_a_number(self):
        self.assert_one_case_fails("text", r"gives a u\[0\] that is no number")

    def test_keys(self):
        self.assert_one_case_fails("other key", 'gives "error"; known are x, u, file, error_linf')
        self.assert_one_case_fails("both", "has to give x and u, or file, or error_linf, and one of these only")
        self.assert_one_case_fails("negative", "gives error_linf = -0.1; an error is not negative")

    def test_files(self):
        self.assert_one_case_fails("no file", "gives a file that is none: .*nothing.npy cannot be read")
        self.assert_one_case_fails("wrong file", r"gives a file that is none: .*wrong.npy does not hold \(x, u\), float64")

    def test_values_that_are_not_finite_are_an_unstable_scheme(self):
        self.run_mode("nan", expect=3)
        self.assertEqual(self.series()["verdict"], "unstable")
        self.assertIn("N = 64: the solution is not finite at T, at x = 0.49087", self.series()["reason"])
        self.assertNotIn("failure", self.series()["cases"][2])

    def test_a_command_that_is_none(self):
        self.run_mode("good", ('"python3"', '"no-such-program"'), expect=3)
        self.assertEqual([case["failure"] for case in self.series()["cases"]],
                         [f"N = {N}: no-such-program solver.py good cannot be started: No such file or directory"
                          for N in (16, 32, 64, 128)])

    def test_no_shell_reads_the_command(self):
        self.run_mode("good; touch here", expect=0)
        self.assertFalse((self.folder / "here").exists())


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
