"""The command line as a user meets it: its words, and what a machine that fails does to it."""

import os
import re
import resource
import shutil
import subprocess
import sys
import unittest

from tests.program import GOOD, LEVELS, ROOT, SCENE, STUDY, ProgramTest, edit, numbers


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


class Timing(ProgramTest):
    def test_repeats_is_the_least_number_of_timed_runs(self):
        self.run_study(STUDY, "--repeats", "7")
        for case in self.result()["series"][0]["cases"]:
            self.assertGreaterEqual(case["repeats"], 7)
            self.assertTrue(0 < case["seconds_low"] <= case["seconds"] <= case["seconds_high"])


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
        self.assertEqual([len(names[what]) for what in ("schemes", "kernels")], [10, 11])
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
        for words in ("A tiny study", "confirmed", "delta = 4h", 'data-figure="tiny"'):
            self.assertIn(words, html)


if __name__ == "__main__":
    unittest.main()
