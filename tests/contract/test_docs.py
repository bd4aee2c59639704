"""README and docs show what the program prints, and what they name is there."""

import os
import re
import subprocess
import sys
import unittest

from tests.program import ACSTUDY, ROOT, STUDY, ProgramTest, edit

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"This\s+is\s+`([\w/.]+)`:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SECONDS = re.compile(r"(?:\d[\d.]*|< 0\.001) s\b")  # that are predicted differ from machine to machine
LINK = re.compile(r"\]\(([^)\s]+)\)")
NAMED = re.compile(r"`((?:solver|mms|studies|reports|tests|scripts|docs|cmake)/(?!out\b)[\w/.-]+)`")


def blocks(text, language):
    return [block for found, block in BLOCK.findall(text) if found == language]


def anchors(text):
    """The anchors of a page's headings, as GitHub makes them."""
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")
            for heading in re.findall(r"^#+ (.*)$", re.sub(BLOCK, "", text), re.MULTILINE)}


class Pages(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "build").mkdir()
        (self.folder / "build" / "acstudy").symlink_to(ACSTUDY)
        python = self.folder / "build" / "python3"
        python.write_text(f"#!/bin/sh\nexec '{sys.executable}' \"$@\"\n", encoding="utf-8")
        python.chmod(0o755)
        for name in ("docs", "examples", "studies"):
            (self.folder / name).symlink_to(ROOT / name)

    def shell(self, command):
        return subprocess.run(["sh", "-c", f'PATH="$PWD/build:$PATH"; {command}'], cwd=self.folder, text=True,
                              env={**os.environ, "PYTHONPATH": str(ROOT / "python"), "ACSTUDY": str(ACSTUDY)},
                              capture_output=True, check=False, timeout=120)

    def test_the_first_page_is_short(self):
        self.assertLessEqual(len(PAGES[0].read_text(encoding="utf-8").splitlines()), 200)

    def test_consoles_show_what_is_printed(self):
        run = 0
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            for name, content in FILE.findall(text):
                if (ROOT / name).exists():
                    self.assertEqual((ROOT / name).read_text(encoding="utf-8"), content, name)
                else:
                    self.write(name, content)
            self.shell("rm -rf out")
            for block in blocks(text, "console"):
                command, _, output = block.partition("\n")
                with self.subTest(page=page.name, command=command):
                    self.assertRegex(command, r"^\$ ")
                    printed = self.shell(command[2:]).stdout
                    if " explain " in command:
                        printed, output = SECONDS.sub("? s", printed), SECONDS.sub("? s", output)
                    self.assertEqual(printed, output)
                    run += 1
        self.assertGreater(run, 5)

    def check_command(self, line):
        """Not run, as it installs or takes minutes: but the target, the option, the study are there."""
        words = line.split()
        if words[0] == "make":
            done = subprocess.run(["make", "-n", *(word for word in words[1:2])], cwd=ROOT, text=True,
                                  capture_output=True, check=False, timeout=60)
        elif words[0].endswith("acstudy"):
            studies = [word for word in words[2:] if word.endswith(".toml")]
            if studies:
                done = self.shell("build/acstudy explain " + " ".join(studies))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
            done = self.acstudy(*words[1:2], "--help")
            for option in re.findall(r"--[a-z-]+", line):
                self.assertIn(option, done.stdout)
        elif words[0] == "python3":
            self.assertTrue((ROOT / words[1]).exists())
            return
        elif words[0] == "pip":
            self.assertEqual((words[1], words[-1]), ("install", "."))
            self.assertTrue((ROOT / "pyproject.toml").exists())
            return
        elif words[0] == "cmake":
            presets = (ROOT / "CMakePresets.json").read_text(encoding="utf-8")
            for preset in re.findall(r"--preset (\w+)", line):
                self.assertIn(f'"name": "{preset}"', presets)
            return
        elif words[0] == "apt-get":
            setup = (ROOT / "scripts" / "setup.sh").read_text(encoding="utf-8")
            self.assertGreater(len(words), 10)
            for package in words[3:]:
                self.assertIn(f" {package} ", setup)
            return
        else:
            self.fail(f"no test knows this command: {line}")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_commands_can_be_given(self):
        checked = set()
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            lines = [line.partition("    #")[0] for block in blocks(text, "sh")
                     for line in block.replace("\\\n", " ").splitlines()]
            lines += [line.partition(" ||")[0] for block in blocks(text, "yaml")
                      for line in re.findall(r"- run: (.*)", block)]
            lines += re.findall(r"`((?:(?:build/)?acstudy [a-z]+|make [a-z]+|python3 \w)[^`]*)`", re.sub(BLOCK, "", text))
            for line in lines:
                with self.subTest(page=page.name, command=line):
                    if line not in checked:
                        self.check_command(line)
                        checked.add(line)

    def test_a_command_that_cannot_be_given_is_seen(self):
        for line in ("make nothing", "build/acstudy run studies/none.toml", "acstudy fit t.csv --nothing", "ls",
                     "python3 none.py", "pip install acstudy", "cmake --preset none"):
            with self.subTest(line), self.assertRaises(AssertionError):
                self.check_command(line)

    def test_keys_in_pieces_of_studies_are_keys(self):
        printed = self.acstudy("list", "keys").stdout
        known = {}
        for block in printed.strip().split("\n\n"):
            keys = {line.split()[0] for line in block.splitlines() if line.startswith("  ")}
            for table in re.findall(r"^\[+([a-z-]+)\]", block, re.MULTILINE):
                known.setdefault(table, set()).update(keys)
        found = 0
        for page in PAGES:
            for block in blocks(page.read_text(encoding="utf-8"), "toml"):
                table = None
                for line in block.splitlines():
                    if heading := re.match(r"\[+([a-z-]+)\]", line):
                        table = heading[1]
                    elif key := re.match(r"(\w+) =", line):
                        with self.subTest(page=page.name, table=table, key=key[1]):
                            self.assertIn(key[1], known[table])
                            found += 1
        self.assertGreater(found, 30)

    def test_the_kernels_of_the_guide_are_some(self):
        guide = (ROOT / "docs" / "guide.md").read_text(encoding="utf-8").partition("## A kernel")[2].partition("\n## ")[0]
        written = re.findall(r"^\| `(\{ .*? \})`", guide, re.MULTILINE)
        written += re.findall(r"kernel = (.*)", guide)
        profiles = re.findall(r'\.profile = (".*?")', guide)
        self.assertEqual((len(written), len(profiles)), (5, 1))
        for kernel in written + [f"{{ profile = {text} }}" for text in profiles]:
            with self.subTest(kernel):
                self.write("study.toml", edit(STUDY, ('"inverse"', kernel)))
                done = self.acstudy("explain", "study.toml")
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_links_and_files_are_there(self):
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            for link in LINK.findall(re.sub(BLOCK, "", text)):
                with self.subTest(page=page.name, link=link):
                    if link.startswith("https://"):
                        continue
                    file, _, anchor = link.partition("#")
                    target = page.parent / file if file else page
                    self.assertTrue(target.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(target.read_text(encoding="utf-8")))
            for name in NAMED.findall(text):
                with self.subTest(page=page.name, file=name):
                    self.assertTrue((ROOT / name).exists())

    def test_each_page_begins_with_its_question_and_a_command_and_is_named_in_the_first(self):
        first = PAGES[0].read_text(encoding="utf-8")
        for page in PAGES[1:]:
            with self.subTest(page=page.name):
                self.assertIn(f"(docs/{page.name})", first)
                if page.name != "equations.md":
                    self.assertRegex(page.read_text(encoding="utf-8"), r"\A# [^\n]*\?\n\n```sh\n")


if __name__ == "__main__":
    unittest.main()
