"""Result files are JSON whatever the numbers are, and check reads what run has written."""

import unittest

from tests.program import ProgramTest, strict_json

# Steps are beyond the bound of their lemma by more than a double can hold.
OVERFLOW = """\
[study]
name = "tiny"

[scene]
period = 1e-5
T = 1
c = "1e308"
u = "sin(2e5*pi*x)"

[[scheme]]
model = 1
kernel = "inverse"

[time]
integrator = "forward-euler"
step = "1"

[[path]]
name = "delta = 4h"
delta = "4*h"
N = [16, 32, 64]
source = "local"
"""


class JsonTest(ProgramTest):
    def test_overflow(self):
        """What is not finite is null in the file, and the gate says the same of the file as of the run."""
        for expect, run_exit, check_exit in (("", 3, 1), ('expect = "unstable"\n', 0, 0)):
            with self.subTest(expect):
                self.run_study(OVERFLOW + expect, expect=run_exit)
                [series] = self.result()["series"]
                self.assertEqual([case["bound"]["largest"] for case in series["cases"]], [None, None, None])
                self.assertEqual([case["error_linf"] for case in series["cases"]], [None, None, None])
                done = self.acstudy("check", "out/tiny.json")
                self.assertEqual((done.returncode, done.stderr), (check_exit, ""), done.stdout)

    def test_bench(self):
        self.write("tiny.toml", OVERFLOW)
        self.acstudy("bench", "tiny.toml", "--out", "out", "--runs", "1", "--least-seconds", "0")
        bench = strict_json((self.folder / "out" / "bench.json").read_text(encoding="utf-8"))
        self.assertEqual([case["error_linf"] for case in bench["cases"]], [None, None, None])

    def test_fit(self):
        """A table with levels that are no numbers, and estimates that there are none of."""
        self.write("t.csv", "h,error\n0.4,nan\n0.2,inf\n0.1,0.1\n")
        fit = strict_json(self.acstudy("fit", "t.csv", "--json").stdout)
        self.assertEqual([level["error"] for level in fit["levels"]], [None, None, 0.1])
        self.assertIsNone(fit["order"])


if __name__ == "__main__":
    unittest.main()
