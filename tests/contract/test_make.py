"""What the targets of the Makefile say: how long they take, and how long their stages took. Nothing is built here."""

import re
import subprocess
import tempfile
import unittest

from tests.program import ROOT


def planned(*arguments):
    """The commands of a target, from a copy of the Makefile beside which nothing can be run."""
    with tempfile.TemporaryDirectory() as folder:
        return subprocess.run(["make", "-n", "-i", "--no-print-directory", "-C", folder, "-f", ROOT / "Makefile", "MAKE=true", *arguments], text=True,
                              capture_output=True, check=False, timeout=60).stdout


class Stages(unittest.TestCase):
    def stage(self, *command):
        return subprocess.run([ROOT / "scripts" / "stage.sh", "built", *command], text=True, capture_output=True,
                              check=False, timeout=60)

    def test_a_stage_says_how_long_it_took_and_exits_as_its_command(self):
        for command, code in ((("true",), 0), (("sh", "-c", "exit 3"), 3), (("printf", "%s", "a  b"), 0)):
            done = self.stage(*command)
            self.assertEqual(done.returncode, code)
            self.assertRegex(done.stderr, r"\Aacstudy: built in \d+ s\n\Z")
        self.assertEqual(done.stdout, "a  b")

    def test_studies_begins_with_time_and_disk_and_has_four_stages(self):
        commands = planned("studies")
        self.assertRegex(commands.splitlines()[0], r"^echo .*some \d+ minutes .* [\d.]+ GB of disk")
        self.assertEqual(re.findall(r"scripts/stage\.sh (\w+)", commands), ["installed", "built", "run", "drawn"])

    def test_what_takes_minutes_says_so(self):
        self.assertIn("some 12 minutes", planned("bench"))
        said = subprocess.run(["make", "help"], cwd=ROOT, text=True, capture_output=True, check=True).stdout
        for target, time in (("bench", "some 12 minutes"), ("compare", "5 minutes; COMPARE=--quick: 45 s"),
                             ("mutants", "some 20 minutes")):
            self.assertRegex(said, rf"\n? +make {target} .*{re.escape(time)}")

    def test_lines_fit_a_terminal(self):
        for target in ("studies", "bench"):
            for line in re.findall(r'echo "([^"]*)"', planned(target)):
                self.assertLessEqual(len(line), 80)


if __name__ == "__main__":
    unittest.main()
