"""The seeded mistakes: each is about the present sources, and says what it is."""

import os
from pathlib import Path
import re
import subprocess
import tempfile
import unittest

from tests.program import ROOT

PATCHES = sorted((ROOT / "tests" / "mutants").glob("*.patch"))


class Mutants(unittest.TestCase):
    def check(self, patch):
        # within a repository above this one git would pass over every file
        environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(ROOT.parent)}
        return subprocess.run(["git", "apply", "--check", patch], cwd=ROOT, env=environment, text=True,
                              capture_output=True, check=False)

    def test_there_are_ten_mistakes_and_a_control(self):
        controls = [patch for patch in PATCHES if patch.stem.startswith("control-")]
        self.assertGreaterEqual(len(PATCHES) - len(controls), 10)
        self.assertGreaterEqual(len(controls), 1)

    def test_every_patch_applies(self):
        for patch in PATCHES:
            with self.subTest(patch.stem):
                done = self.check(patch)
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_patch_that_does_not_fit_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            stale = Path(folder) / "stale.patch"
            stale.write_text(re.sub(r"^ ", " not there any more ", PATCHES[0].read_text(encoding="utf-8"), flags=re.M),
                             encoding="utf-8")
            self.assertNotEqual(self.check(stale).returncode, 0)

    def test_every_patch_says_what_it_is_and_is_there_once(self):
        said, changes = [], []
        for patch in PATCHES:
            what, _, diff = patch.read_text(encoding="utf-8").partition("\n")
            with self.subTest(patch.stem):
                self.assertRegex(what, r"\A[^-+@ ].{20,}")
                self.assertRegex(diff, r"\A--- a/(solver|mms|studies)/(\S+)\n\+\+\+ b/\1/\2\n@@")
            said.append(what)
            changes.append(re.findall(r"^[-+](?![-+]{2} ).*", diff, re.M))
        for everything in (said, changes):
            self.assertEqual([one for one in everything if everything.count(one) > 1], [])


if __name__ == "__main__":
    unittest.main()
