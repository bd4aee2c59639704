"""Shares of studies, joined, are what one run gives; and nobody writes what another writes."""

import os
import shutil
import signal
import subprocess
import time
import unittest

from tests.program import ACSTUDY, CASES_OF_WIDE, STUDY, WIDE, ProgramTest, edit, numbers

IDENTITIES = STUDY[:STUDY.index("[time]")].replace('"tiny"', '"finds"').replace(
    'title = "A tiny study"', 'kind = "identities"') + "[sweep]\nN = [16]\nratios = [2]\n"
MAP = STUDY[:STUDY.index("[[path]]")].replace('"tiny"', '"plane"').replace('title = "A tiny study"', 'kind = "map"') + (
    '[map]\ndelta = [0.2, 0.3, 0.4, 0.8]\nN = [20, 28, 40, 57]\nsources = ["local"]\n')
ADDED = edit(STUDY, ('"tiny"', '"added"'), ("[16, 32, 64]", '{ from = 16, until = "decided", most = 256 }'))
LONG = edit(STUDY, ("4*h", "0.5"), ("[16, 32, 64]", str(list(range(2000, 2400)))), ('source = "local"', 'source = "nonlocal"'))


class Shards(ProgramTest):
    def setUp(self):
        super().setUp()
        texts = {"tiny": WIDE, "finds": IDENTITIES, "plane": MAP, "added": ADDED}
        for name, text in texts.items():
            self.write(f"{name}.toml", text)
        self.studies = [f"{name}.toml" for name in texts]
        self.names = list(texts)

    def shares(self, count, folder):
        for number in range(1, count + 1):
            done = self.acstudy("run", *self.studies, "--out", folder.format(number), "--shard", f"{number}/{count}")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertRegex(done.stdout, rf"\Ashare {number}/{count}: \d+ cases and \d+ findings computed")

    def assert_same(self, out, as_in="whole"):
        for name in self.names:
            self.assertEqual(numbers(self.folder / out / f"{name}.h5"), numbers(self.folder / as_in / f"{name}.h5"))

    def test_whatever_the_split_the_numbers_are_the_same(self):
        whole = self.acstudy("run", *self.studies, "--out", "whole")
        for count, folder in ((2, "two"), (7, "seven-{}")):
            with self.subTest(count):
                self.shares(count, folder)
                folders = sorted({folder.format(number) for number in range(1, count + 1)})
                done = self.acstudy("merge", *folders, "--out", "merged")
                self.assertEqual(done.returncode, whole.returncode)
                self.assertIn("0 cases computed", done.stdout)
                self.assert_same("merged")
                self.assertEqual(sorted(os.listdir(self.folder / "merged")),
                                 sorted(f"{name}{end}" for name in self.names for end in (".h5", ".json")))
                shutil.rmtree(self.folder / "merged")
        # Into their own folder; what the shares left is then gone. So it is with a run in their place.
        shutil.copytree(self.folder / "two", self.folder / "again")
        self.acstudy("merge", "two", "--out", "two")
        done = self.acstudy("run", *self.studies, "--out", "again")
        self.assertIn("0 cases computed", done.stdout)
        for folder in ("two", "again"):
            self.assert_same(folder)
            self.assertEqual(len(os.listdir(self.folder / folder)), 2 * len(self.names))

    def test_what_is_missing_or_does_not_fit_is_refused(self):
        self.shares(2, "part-{}")
        done = self.acstudy("merge", "part-1", "--out", "merged")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, r"acstudy: .*added.toml: \d+ cases and 0 findings of study \"added\" are stored in "
                                      r"none of the folders|finds.toml: 0 cases and \d+ findings")
        self.assertEqual(os.listdir(self.folder / "merged"), [])
        self.write("tiny.toml", edit(WIDE, ("mu = 1.5", "mu = 1.6")))
        self.acstudy("run", "tiny.toml", "--out", "part-3", "--shard", "1/2")
        done = self.acstudy("merge", "part-1", "part-2", "part-3", "--out", "merged")
        self.assertEqual(done.returncode, 2)
        self.assertIn('study "tiny" has another text than in', done.stderr)
        (self.folder / "empty").mkdir()
        for folders, said in ((["empty"], "no results in this folder"), (["none"], "none: no folder")):
            done = self.acstudy("merge", *folders, "--out", "merged")
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)
        for shard in ("0/2", "3/2", "1", "1/", "/2", "a/b", "1/2/3", "-1/2", "1/1000000", ""):
            with self.subTest(shard):
                done = self.acstudy("run", "tiny.toml", "--out", "none", f"--shard={shard}")
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertIn("--shard", done.stderr)
        self.assertFalse((self.folder / "none").exists())

    def test_a_share_goes_on_from_what_it_left(self):
        run = ("run", "tiny.toml", "--out", "out", "--shard", "1/2")
        first, again = self.acstudy(*run).stdout, self.acstudy(*run).stdout
        self.assertRegex(again, r"share 1/2: 0 cases and 0 findings computed, [1-9]\d* taken")
        self.assertNotIn(" 0 cases", first)
        done = self.acstudy("run", "tiny.toml", "--out", "out")
        self.assertNotIn(f"{CASES_OF_WIDE} cases computed", done.stdout)


class TwoAtOnce(ProgramTest):
    def start(self, *arguments):
        process = subprocess.Popen([ACSTUDY, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        for close in (process.stderr.close, process.stdout.close, process.wait, process.kill):
            self.addCleanup(close)
        return process

    def await_lock(self, name):
        limit = time.monotonic() + 30
        while not (self.folder / "out" / name).exists():
            self.assertLess(time.monotonic(), limit)
            time.sleep(0.02)

    def test_the_second_says_who_is_there(self):
        self.write("tiny.toml", LONG)
        self.write("other.toml", edit(STUDY, ('"tiny"', '"other"')))
        process = self.start("run", "tiny.toml", "--out", "out")
        self.await_lock("tiny.lock")
        for second in (("run", "tiny.toml", "--out", "out"), ("run", "tiny.toml", "--out", "out", "--shard", "1/2")):
            done = self.acstudy(*second)
            self.assertEqual((done.returncode, done.stdout), (4, ""))
            self.assertRegex(done.stderr, rf"\Aacstudy: out/tiny.lock: locked by process {process.pid} on \S+ since "
                                          r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d, .*--out\n\Z")
        self.assertIn("3 cases computed", self.acstudy("run", "other.toml", "--out", "out").stdout)
        # Whoever is killed holds nothing.
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.write("tiny.toml", STUDY)
        self.assertIn("cases computed", self.acstudy("run", "tiny.toml", "--out", "out").stdout)
        self.assertFalse((self.folder / "out" / "tiny.lock").exists())

    def test_benches_too(self):
        self.write("tiny.toml", STUDY)
        process = self.start("bench", "tiny.toml", "--out", "out", "--least-seconds", "60")
        self.await_lock("bench.lock")
        done = self.acstudy("bench", "tiny.toml", "--out", "out")
        self.assertEqual(done.returncode, 4)
        self.assertIn(f"bench.lock: locked by process {process.pid}", done.stderr)

    def test_leftovers_of_a_kill_are_removed(self):
        out = self.folder / "out"
        out.mkdir()
        for name in ("tiny.h5.0123456789abcdef.partial", "tiny.json.0123456789abcdef.partial", "other.h5.1.partial"):
            (out / name).write_text("x", encoding="utf-8")
        self.run_study(STUDY)
        self.assertEqual(sorted(os.listdir(out)), ["other.h5.1.partial", "tiny.h5", "tiny.json"])


if __name__ == "__main__":
    unittest.main()
