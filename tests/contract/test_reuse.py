"""What is stored is not computed again, whatever ended the run before."""

import os
import pty
import re
import signal
import subprocess
import time
import unittest

import h5py

from tests.program import (ACSTUDY, CASES_OF_WIDE, FIELDS, GOOD, LEVELS, MODEL_II, ROOT, STUDY, USE, WIDE,
                           ProgramTest, edit, numbers, reseal, series_of)


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

    def test_what_an_older_file_does_not_hold_yet_is_no_obstacle(self):
        self.run_study(STUDY)
        first = self.result()
        with h5py.File(self.folder / "out" / "tiny.h5", "r+") as file:
            for series in series_of(file):
                for name in ("last_time", "bound_first_place", "solution_linf"):
                    del series[name]
        reseal(self.folder / "out" / "tiny.h5")
        self.assert_counts(self.run_study(edit(STUDY, ("A tiny", "The same"))), 0, 3)
        for case in first["series"][0]["cases"]:
            case["solution_linf"] = 0.0
        self.assertEqual(self.result()["series"][0]["cases"], first["series"][0]["cases"])
        with h5py.File(self.folder / "out" / "tiny.h5", "r+") as file:
            del series_of(file)[0]["N"]
        reseal(self.folder / "out" / "tiny.h5")
        self.assertEqual(self.run_study(STUDY).returncode, 4)

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
        self.assertIn("acstudy: interrupted; finished cases are stored, and the same command goes on from them",
                      " ".join(said.split()))
        self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])

        finished = int(re.search(r"(\d+) cases computed", out)[1])
        self.assertTrue(3 <= finished < 50, out)
        series, = self.result()["series"]
        self.assertEqual((len(series["cases"]), series["cases_planned"]), (finished, 50))
        with h5py.File(self.folder / "out" / "tiny.h5", "r") as file:
            self.assertEqual(len(series_of(file)[0]["cases"]), finished)
        checked = self.acstudy("check", "-v", "out/tiny.json")
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


if __name__ == "__main__":
    unittest.main()
