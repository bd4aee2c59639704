"""What scripts/kills.py does five hundred times, eight times; and signals that end a run in time."""

import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

from tests.program import ACSTUDY, ROOT, STUDY, ProgramTest, edit

# A step takes seconds here, and the first is far away: particles so many that to place them takes its time.
LARGE = edit(STUDY, ("4*h", "0.9"), ("[16, 32, 64]", "[60000]"))
FINDINGS = (ROOT / "studies" / "extremes.toml").read_text(encoding="utf-8")


class Kills(ProgramTest):
    def test_nothing_is_lost(self):
        done = subprocess.run([sys.executable, ROOT / "scripts" / "kills.py", "--kills", "8", "--acstudy", ACSTUDY],
                              text=True, capture_output=True, check=False, timeout=300)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertEqual(done.stdout.count("kills survived"), 4)


class Signals(ProgramTest):
    def end(self, arguments, sig, after=0.5, **options):
        process = subprocess.Popen([ACSTUDY, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, **options)
        self.addCleanup(process.kill)
        limit = time.monotonic() + 30
        while not list((self.folder / "out").glob("*.lock")) and time.monotonic() < limit:
            time.sleep(0.02)
        time.sleep(after)
        self.assertIsNone(process.poll(), "it ended too soon")
        begin = time.monotonic()
        process.send_signal(sig)
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err, time.monotonic() - begin

    def test_they_end_what_runs_within_a_second(self):
        self.write("large.toml", LARGE)
        self.write("near.toml", edit(LARGE, ("0.9", "0.01")))
        self.write("finds.toml", FINDINGS)
        for arguments, sig in ((["run", "near.toml", "--form", "readable"], signal.SIGINT),
                               (["run", "large.toml"], signal.SIGTERM), (["run", "finds.toml"], signal.SIGHUP),
                               (["bench", "large.toml"], signal.SIGINT)):
            with self.subTest(arguments=arguments, sig=sig):
                code, _, err, seconds = self.end([*arguments, "--out", "out"], sig)
                self.assertEqual(code, 130, err)
                self.assertIn("interrupted; finished ", err)
                self.assertLess(seconds, 1.0)
                self.assertEqual([name for name in os.listdir(self.folder / "out") if name.endswith(".lock")], [])
                shutil.rmtree(self.folder / "out")

    def test_a_hang_up_that_is_ignored_stays_ignored(self):
        self.write("large.toml", LARGE)
        ignoring = dict(preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        process = subprocess.Popen([ACSTUDY, "run", "large.toml"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, **ignoring)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        time.sleep(0.3)
        process.send_signal(signal.SIGHUP)
        time.sleep(0.9)
        self.assertIsNone(process.poll())


if __name__ == "__main__":
    unittest.main()
