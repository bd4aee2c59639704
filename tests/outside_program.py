"""A study whose scheme is a program, which does what the study says."""

import os
import signal
import sys
import time

from tests.program import ProgramTest, edit

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
