"""A run loses nothing: not when it is interrupted or killed, and not to another study of the same name."""

import io
import os
import re
import signal
import struct
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

from tests.program import ACSTUDY, LEVELS, MODEL_II, ROOT, STUDY, ProgramTest, edit, numbers, reseal

MARK = b"\n\x89acstudy-rec-2\n"
# Cases of some hundredths of a second, minutes of them; most are never run here.
MANY = list(range(1000, 1400))
LONG = edit(STUDY, ("4*h", "0.5"), (LEVELS, str(MANY)), ('source = "local"', 'source = "nonlocal"'))
# Cases on the same particles, which run together and take seconds.
TOGETHER = edit(STUDY, (LEVELS, "[1500]"), MODEL_II, ('"forward-euler"', '"ssprk3"'))
TOGETHER += "".join(f'\n[[path]]\nname = "{i}"\ndelta = {0.3 + i / 100}\nN = [1500]\nsource = "local"\n' for i in range(40))
MAP = STUDY[:STUDY.index("[[path]]")].replace('title = "A tiny study"', 'kind = "map"') + """\
[map]
delta = [0.04, 0.16, 0.4, 0.6]
N = [57, 80, 113, 160]
sources = ["local", "nonlocal"]
"""


def records(journal):
    """The bytes of the whole records of a journal."""
    content, at = journal.read_bytes() if journal.exists() else b"", 0
    while (at := content.find(MARK, at)) >= 0:
        head = content[at + len(MARK):at + len(MARK) + 16]
        if len(head) < 16:
            return
        size, _ = struct.unpack("=QQ", head)
        at += len(MARK) + 16
        if at + size <= len(content):
            yield content[at:at + size]
        at += size


KEY = {"cases": b"\x64case", "findings": b"\x67finding"}  # texts of CBOR


def of_kind(journal, what):
    return [record for record in records(journal) if KEY[what] in record]


def level(record):
    return int(re.search(rb"\|N=(\d+)\|", record)[1])


def image(record):
    """The HDF5 image of a finding, in a name of CBOR and four bytes of length."""
    start = record.index(b"\x65image") + 6
    width = {0x58: 1, 0x59: 2, 0x5a: 4}[record[start]]
    size = int.from_bytes(record[start + 1:start + 1 + width], "big")
    return record[start + 1 + width:start + 1 + width + size]


def count(journal, what):
    return len(of_kind(journal, what))


class Keeping(ProgramTest):
    def start(self, *arguments):
        process = subprocess.Popen([ACSTUDY, "run", "tiny.toml", "--out", "out", *arguments], cwd=self.folder,
                                   text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for close in (process.stderr.close, process.stdout.close, process.wait, process.kill):
            self.addCleanup(close)
        return process

    @property
    def journal(self):
        return self.folder / "out" / "tiny.journal"

    def await_journal(self, process, what, least=1):
        """Waits until so many cases or findings are on the disk."""
        limit = time.monotonic() + 120
        while (stored := count(self.journal, what)) < least:
            self.assertIsNone(process.poll(), "it ended too soon")
            self.assertLess(time.monotonic(), limit, "nothing was saved")
            time.sleep(0.05)
        return stored

    def end(self, process, sig):
        process.send_signal(sig)
        return process.communicate(timeout=60)


class Cases(Keeping):
    def check(self, text, sig):
        self.write("tiny.toml", text)
        process = self.start()
        stored = self.await_journal(process, "cases", 2)
        out, err = self.end(process, sig)
        if sig == signal.SIGINT:
            self.assertEqual(process.returncode, 130)
            self.assertIn("interrupted; finished cases are stored", err)
            self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])
            finished = int(re.search(r"(\d+) cases computed, 0 taken", out)[1])
            self.assertGreaterEqual(finished, stored)
            cases = [case for series in self.result()["series"] for case in series["cases"]]
            self.assertEqual(len(cases), finished)
            stored = finished
        else:
            self.assertEqual(process.returncode, -signal.SIGKILL)
            # The lock says who held it; nobody does.
            self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.journal", "tiny.lock"])
            stored = max(stored, count(self.journal, "cases"))
        return stored

    def go_on(self, text, stored, least):
        """Runs the study made shorter, which must take at least so many cases from the store."""
        done = self.run_study(text)
        computed, taken = map(int, re.search(r"(\d+) cases computed, (\d+) taken", done.stdout).groups())
        self.assertTrue(least <= taken <= stored, done.stdout)
        self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])
        self.run_study(text, out="fresh")
        self.assertEqual(numbers(self.folder / "out" / "tiny.h5"), numbers(self.folder / "fresh" / "tiny.h5"))
        self.assert_counts(self.run_study(text), 0, computed + taken)

    def kept_levels(self):
        """The levels of the cases that are in the journal or, after an interruption, in the results."""
        if self.journal.exists():
            return sorted(map(level, of_kind(self.journal, "cases")))
        return [case["N"] for case in self.result()["series"][0]["cases"]]

    def test_cases_of_many_ensembles(self):
        for sig in (signal.SIGINT, signal.SIGKILL):
            with self.subTest(sig):
                subprocess.run(["rm", "-rf", "out", "fresh"], cwd=self.folder, check=True)
                stored = self.check(LONG, sig)
                levels = self.kept_levels()
                self.assertEqual(len(levels), stored)
                # One more level instead of all that are left, to save time.
                self.go_on(edit(LONG, (str(MANY), str([100, *levels[:10]]))), len(levels), min(10, len(levels)))

    def test_cases_of_one_ensemble_do_not_all_wait_for_its_end(self):
        for sig in (signal.SIGINT, signal.SIGKILL):
            with self.subTest(sig):
                subprocess.run(["rm", "-rf", "out", "fresh"], cwd=self.folder, check=True)
                stored = self.check(TOGETHER, sig)
                self.assertLess(stored, 41)

    def test_a_torn_record_is_passed_over(self):
        self.write("tiny.toml", LONG)
        process = self.start()
        self.await_journal(process, "cases", 2)
        self.end(process, signal.SIGKILL)
        whole = self.journal.read_bytes()
        levels = self.kept_levels()
        text = edit(LONG, (str(MANY), str(levels)))
        of_study, first = list(records(self.journal))[:2]
        begin = len(MARK) + 16 + len(of_study)
        record = whole[begin:begin + len(MARK) + 16 + len(first)]
        self.assertTrue(record.startswith(MARK) and record.endswith(first))
        broken = bytearray(record)
        broken[len(record) // 2] ^= 1
        for what, content, left in (("torn at its end", whole + record[:-7], len(levels)),
                                    ("torn, then written on", record[:len(record) // 2] + whole, len(levels)),
                                    ("one bit", bytes(broken) + whole[:begin], 0), ("its head", record + whole[:20], 1)):
            with self.subTest(what):
                for name in ("tiny.h5", "tiny.json"):
                    (self.folder / "out" / name).unlink(missing_ok=True)
                self.journal.write_bytes(content)
                done = self.run_study(text)
                self.assert_counts(done, len(levels) - left, left)
                self.assertEqual("not as it was written" in done.stderr, what in ("torn, then written on", "one bit"))
                self.assertFalse(self.journal.exists())


class Findings(Keeping):
    """Findings are kept like cases, whether their study has runs or none."""

    def stored(self):
        return numbers(self.folder / "out" / "tiny.h5")

    def test_those_of_runs_are_taken_again_if_nothing_changed(self):
        self.run_study(MAP)
        first = self.stored()
        # Whether a finding is measured or taken again, only the file can tell.
        path = self.folder / "out" / "tiny.h5"
        with h5py.File(path, "a") as file:
            file["findings/0000"].attrs["remark"] = np.bytes_("taken again")
        reseal(path)
        self.assert_counts(self.run_study(MAP), 0, 32)
        changed = self.stored()
        self.assertEqual([key for key in first if first[key] != changed[key]], ["findings/0000@remark"])
        for text, arguments in ((MAP, ["--fresh"]), (edit(MAP, ("0.6]", "0.6]  # a remark")), []),
                                (edit(MAP, ("[0.04, 0.16, 0.4, 0.6]", "[0.04, 0.16, 0.4, 0.6, 0.8]")), [])):
            with self.subTest(text=text, arguments=arguments):
                self.run_study(MAP)
                with h5py.File(path, "a") as file:
                    file["findings/0000"].attrs["remark"] = np.bytes_("taken again")
                reseal(path)
                self.run_study(text, *arguments)
                self.assertEqual(self.stored()["findings/0000@remark"], first["findings/0000@remark"])

    def test_those_that_are_taken_survive_the_end(self):
        text = (ROOT / "studies" / "consistency.toml").read_text(encoding="utf-8")
        self.write("tiny.toml", edit(text, ('name = "consistency"', 'name = "tiny"')))
        process = self.start()
        self.await_journal(process, "findings", 3)
        self.end(process, signal.SIGKILL)
        values = {}
        for record in of_kind(self.journal, "findings"):
            with h5py.File(io.BytesIO(image(record)), "r") as file:
                number = re.search(rb"\x67finding(\x18.|\x19..|.)", record, re.DOTALL)[1]
                name = f"{int.from_bytes(number[1:] or number, 'big'):04d}"
                values[name] = file["finding"]["value"][()].tobytes()
        self.assertGreaterEqual(len(values), 3)
        process = self.start()
        time.sleep(0.3)
        self.end(process, signal.SIGINT)
        self.assertEqual(process.returncode, 130)
        with h5py.File(self.folder / "out" / "tiny.h5", "r") as file:
            for name, value in values.items():
                self.assertEqual(file["findings"][name]["value"][()].tobytes(), value)


class OtherStudies(ProgramTest):
    """Results are not replaced by those of another file."""

    def setUp(self):
        super().setUp()
        self.run_study(STUDY)
        self.before = numbers(self.folder / "out" / "tiny.h5")

    def refused(self, *arguments):
        done = self.acstudy("run", *arguments, "--out", "out")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        for words in ("copy.toml: study \"tiny\" would replace", str(self.folder.resolve() / "tiny.toml"),
                      "out/tiny.h5", "--out"):
            self.assertIn(words, done.stderr)
        self.assertEqual(numbers(self.folder / "out" / "tiny.h5"), self.before)
        self.assertEqual(sorted(os.listdir(self.folder / "out")), ["tiny.h5", "tiny.json"])

    def test_another_file_with_another_text_is_refused_fresh_or_not(self):
        self.write("copy.toml", edit(STUDY, (LEVELS, "[16, 32, 128]")))
        self.write("good.toml", edit(STUDY, ('"tiny"', '"good"')))
        self.refused("copy.toml")
        self.refused("copy.toml", "--fresh")
        self.refused("good.toml", "copy.toml")
        self.assertEqual(self.acstudy("run", "copy.toml", "--out", "elsewhere").returncode,
                         self.acstudy("run", "tiny.toml", "--out", "out").returncode)

    def test_the_same_text_elsewhere_and_another_text_in_place_are_not(self):
        self.write("copy.toml", STUDY)
        self.assert_counts(self.acstudy("run", "copy.toml", "--out", "out"), 0, 3)
        self.write("copy.toml", edit(STUDY, (LEVELS, "[16, 32]")))
        self.assert_counts(self.acstudy("run", "copy.toml", "--out", "out"), 0, 2)
        (self.folder / "link.toml").symlink_to("copy.toml")
        self.write("copy.toml", STUDY)
        self.assert_counts(self.acstudy("run", "./link.toml", "--out", "out"), 1, 2)

    def test_a_file_of_an_older_version_belongs_to_no_study(self):
        with h5py.File(self.folder / "out" / "tiny.h5", "a") as file:
            del file.attrs["study_file"]
        reseal(self.folder / "out" / "tiny.h5")
        self.write("copy.toml", edit(STUDY, (LEVELS, "[16, 32]")))
        self.assert_counts(self.acstudy("run", "copy.toml", "--out", "out"), 0, 2)


class Locked(ProgramTest):
    """A result file that another program has open for writing."""

    def setUp(self):
        super().setUp()
        self.run_study(STUDY)

    def hold(self, seconds):
        code = ("import h5py, sys, time\nwith h5py.File('out/tiny.h5', 'a'):\n"
                f"    print('open', flush=True)\n    time.sleep({seconds})\n")
        environment = {key: value for key, value in os.environ.items() if key != "HDF5_USE_FILE_LOCKING"}
        process = subprocess.Popen([sys.executable, "-c", code], cwd=self.folder, stdout=subprocess.PIPE,
                                   env=environment)
        for close in (process.stdout.close, process.wait, process.kill):
            self.addCleanup(close)
        self.assertEqual(process.stdout.readline(), b"open\n")
        return process

    def test_it_is_called_locked_and_not_broken(self):
        self.hold(60)
        for fresh in ((), ("--fresh",)):
            done = self.run_study(STUDY, *fresh)
            self.assertEqual((done.returncode, done.stdout), (4, ""))
            self.assertRegex(done.stderr, r"\Aacstudy: out/tiny.h5: locked: .*close it there.*--out\n\Z")
            self.assertNotIn("remove", done.stderr)

    def test_a_moment_is_waited(self):
        self.hold(0.7)
        self.assert_counts(self.run_study(STUDY), 0, 3)

    def test_without_locks_it_is_read(self):
        self.hold(60)
        self.assert_counts(self.run_study(STUDY, env=os.environ | {"HDF5_USE_FILE_LOCKING": "FALSE"}), 0, 3)


if __name__ == "__main__":
    unittest.main()
