"""What a user sees on a terminal and off it: progress, widths, colors, quiet and verbose runs."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time
import unittest

from tests.program import ACSTUDY, GOOD, LEVELS, STUDY, USE, WIDE, ProgramTest, edit

CONTROL = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
SLOW = edit(STUDY, ("4*h", "0.5"), (LEVELS, str(list(range(1000, 1030)))), ('source = "local"', 'source = "nonlocal"'))
WRONG = edit(GOOD, ('source = "local"', 'source = "local"\nexpect = "above"'))


class Terminal(ProgramTest):
    def on_terminal(self, *arguments, columns=80, lines=24, **environment):
        """(exit code, everything that a terminal of this size is sent)."""
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        known = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "NO_COLOR")}
        process = subprocess.Popen([ACSTUDY, *map(str, arguments)], cwd=self.folder, stdin=theirs, stdout=theirs,
                                   stderr=theirs, env={**known, "TERM": "xterm", **environment})
        os.close(theirs)
        sent, limit = b"", time.monotonic() + 120
        while time.monotonic() < limit:
            if not select.select([ours], [], [], 0.1)[0]:
                continue
            try:
                chunk = os.read(ours, 65536)
            except OSError:  # how Linux says that the other side is closed
                break
            if not chunk:
                break
            sent += chunk
        return process.wait(timeout=10), sent.decode().replace("\r\n", "\n")

    def lines_left(self, text):
        """The lines that stand on the terminal in the end; only what the program sends is understood."""
        lines, row = [""], 0
        for part in re.split(r"(\x1b\[\d*[A-Za-z]|\x1b\[[0-9;]*m|\n|\r)", text):
            if part == "\n":
                row += 1
                if row == len(lines):
                    lines.append("")
            elif part.endswith("A") and part.startswith("\x1b"):
                row -= int(part[2:-1])
                self.assertGreaterEqual(row, 0)
            elif part == "\x1b[J":
                lines[row:] = [""]
            elif part == "\x1b[K":
                lines[row] = ""
            elif part and part != "\r" and not part.startswith("\x1b"):
                lines[row] += part
        return lines

    def test_a_run_shows_its_progress_and_leaves_a_summary(self):
        self.write("slow.toml", edit(SLOW, ('"tiny"', '"slow"')))
        self.write("good.toml", GOOD)
        code, sent = self.on_terminal("run", "slow.toml", "good.toml", "--out", "out")
        self.assertIn(code, (0, 1))
        self.assertRegex(sent, r"\d+ of \d+ cases, \d+ s")
        self.assertRegex(sent, r"slow +\d+ %  \d+ of 30 cases, about \d+ s left")
        left = self.lines_left(sent)
        self.assertEqual([line for line in left if "about" in line], [])
        # A line per study that is done, then the summary.
        for study in (r"slow  30 cases, \d.* s", r"tiny  4 cases, .* s"):
            self.assertEqual(len([line for line in left if re.fullmatch(study, line)]), 1, left)
        self.assertRegex(left[-2], "34 cases computed, 0 taken from the store; results in out")

    def test_off_a_terminal_there_are_no_control_characters(self):
        for text in (GOOD, WRONG, WIDE):
            done = self.run_study(text, "--fresh")
            for said in (done.stdout, done.stderr):
                self.assertNotRegex(said, r"[\x00-\x08\x0b-\x1f]")
        self.assertNotIn("\x1b", self.acstudy("check", "out/tiny.json").stdout)

    def test_colors_are_for_terminals_that_want_them(self):
        self.run_study(WRONG, expect=1)
        for environment, colored in (({}, True), ({"NO_COLOR": "1"}, False), ({"NO_COLOR": ""}, True),
                                     ({"TERM": "dumb"}, False)):
            for command in (("run", "tiny.toml", "--out", "out"), ("check", "out/tiny.json")):
                with self.subTest(environment=environment, command=command):
                    code, sent = self.on_terminal(*command, **environment)
                    self.assertEqual(code, 1)
                    self.assertEqual("\x1b[1;31mDEPART\x1b[0m" in sent, colored, sent)
                    self.assertEqual(re.search(r"\x1b\[[0-9;]*m", sent) is not None, colored)

    def test_no_line_is_longer_than_the_terminal(self):
        self.write("wide.toml", edit(WIDE, ('"tiny"', '"wide"')))
        self.run_study(WRONG, expect=1)
        for columns in (60, 80, 200):
            for command in (("run", "wide.toml", "tiny.toml", "--out", "out"),
                            ("run", "-v", "wide.toml", "tiny.toml", "--out", "out"),
                            ("check", "-v", "out/tiny.json", "out/wide.json"), ("list",), ("list", "keys"), ("--help",),
                            ("run", "--help"), ("fit", "--help"), ("bench", "--help"), ("explain", "wide.toml"),
                            ("frobnicate",)):
                with self.subTest(columns=columns, command=command):
                    _, sent = self.on_terminal(*command, columns=columns)
                    lines = re.split(r"[\n\r]", CONTROL.sub("", sent))
                    long = [line for line in lines if len(line) > columns]
                    self.assertEqual(long, [])

    def test_columns_says_how_wide_where_no_terminal_does(self):
        self.run_study(WRONG)
        for columns, most in ((None, 80), ("50", 50), ("none", 80), ("0", 80)):
            environment = {**os.environ, "COLUMNS": columns} if columns else {
                name: value for name, value in os.environ.items() if name != "COLUMNS"}
            done = self.acstudy("check", "out/tiny.json", env=environment)
            widths = [len(line) for line in done.stdout.splitlines()]
            self.assertTrue(most - 25 < max(widths) <= most, widths)


class QuietAndVerbose(ProgramTest):
    def test_without_either_a_run_says_what_departs_and_counts_the_rest(self):
        self.assertEqual(self.run_study(GOOD, expect=0).stdout,
                         "1 finding of 1 study, all as expected: 1 confirmed\n"
                         "4 cases computed, 0 taken from the store; results in out\n")
        said = self.run_study(WRONG, expect=1).stdout
        self.assertRegex(said, r"\ADEPART  tiny: Model I, local divergence, inverse, delta = 4h\n"
                               r" {8}\d\.\d\d \[.*\]  confirmed, expected above: ")
        self.assertIn("1 finding of 1 study, 1 depart: 1 confirmed\n", said)

    def test_verbose_is_a_table_of_every_series(self):
        lines = self.run_study(WIDE, "-v").stdout.splitlines()
        self.assertRegex(lines[0], r"^gate +study +name +observed +verdict$")
        self.assertEqual([line.split()[1] for line in lines[1:10]], ["tiny"] * 9)
        self.assertEqual(self.acstudy("check", "--verbose", "out/tiny.json").stdout.splitlines()[:10], lines[:10])

    def test_quiet_is_what_departs(self):
        for text, exit_code in ((GOOD, 0), (WRONG, 1)):
            done = self.run_study(text, "--quiet", expect=exit_code)
            checked = self.acstudy("check", "--quiet", "out/tiny.json")
            self.assertEqual((checked.returncode, checked.stderr, done.stderr), (exit_code, "", ""))
            self.assertEqual(done.stdout, checked.stdout)
            self.assertEqual(done.stdout.count("DEPART"), exit_code)
            self.assertEqual(bool(done.stdout), exit_code == 1)
        done = self.acstudy("run", "tiny.toml", "-v", "--quiet")
        self.assertEqual((done.returncode, done.stdout), (2, ""))

    def test_check_says_one_line_if_all_is_well(self):
        self.run_study(GOOD, expect=0)
        self.assertEqual(self.acstudy("check", *["out/tiny.json"] * 5).stdout, "5 gates, 0 depart\n")

    def test_steps_beyond_a_bound_are_a_line_per_study_and_in_the_results_in_full(self):
        closing = edit(STUDY, (USE, USE + "\nT = 1.5"), ('"h/4"', '"h/4"\nexpect = "stable"'))
        several = closing + closing[closing.index("[[path]]"):].replace("delta = 4h", "delta = 2h").replace("4*h", "2*h")
        for name in "abcdef":
            self.write(f"{name}.toml", edit(several, ('"tiny"', f'"{name}"')))
        done = self.acstudy("run", *(f"{name}.toml" for name in "abcdef"), "--out", "out")
        self.assertEqual(done.returncode, 0)
        notes = done.stderr.splitlines()
        for name, note in zip("abc", notes):
            self.assertRegex(note, rf"\Aacstudy: note: {name}: steps of 2 of 2 series are beyond the bound of "
                                   r"Lemma 2\.4, by a factor of up to 1\.\d+\Z")
        self.assertEqual(notes[3:], ["acstudy: note: steps of 3 more studies are, too; each case's are in the result files"])
        for series in self.result("f")["series"]:
            for case in series["cases"]:
                self.assertGreater(case["bound"]["largest"], 1.25)
                self.assertGreater(case["bound"]["first_step"], 0)


if __name__ == "__main__":
    unittest.main()
