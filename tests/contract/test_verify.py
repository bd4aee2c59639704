"""acstudy verify computes what is stored anew."""

import unittest

import h5py

from tests.program import STUDY, UNSOLVED, WIDE, ProgramTest, edit, reseal

IDENTITIES = STUDY[:STUDY.index("[time]")].replace('title = "A tiny study"', 'kind = "identities"') + (
    "[sweep]\nN = [16]\nratios = [2]\n")


class Verify(ProgramTest):
    def verify(self, *arguments, expect):
        done = self.acstudy("verify", *arguments)
        self.assertEqual((done.returncode, done.stderr), (expect, ""), done.stdout)
        return done.stdout

    def test_what_was_computed_is_computed_again(self):
        for text, items in ((WIDE, 21), (UNSOLVED, 3)):
            self.run_study(text)
            self.assertEqual(self.verify("out", "--all", expect=0),
                             f"out/tiny.h5: {items} of {items} cases and findings computed anew, equal to the last bit\n")
        self.run_study(UNSOLVED, "--form", "readable", out="readable")
        self.verify("readable/tiny.json", expect=0)
        self.run_study(IDENTITIES)
        self.assertRegex(self.verify("out/tiny.h5", "--sample", "3", expect=0), r"3 of \d+ cases and findings computed anew")

    def test_what_differs_is_named(self):
        self.run_study(STUDY)
        file = self.folder / "out" / "tiny.h5"
        with h5py.File(file, "r+") as opened:
            opened["series/000/error_linf"][1] *= 1 + 1e-9
        done = self.acstudy("verify", "out", "--all")
        self.assertEqual((done.returncode, done.stdout), (4, ""))
        self.assertIn("tiny.h5: not a readable result file (it is not as it was written)", done.stderr)
        reseal(file)
        said = self.verify("out", "--all", expect=1)
        self.assertRegex(said, r"3 of 3 .*, 1 differ\n  Model I, .*delta = 4h, N = 32: error_linf is 0\.\d+ and was stored as")
        self.assertIn("the largest difference is 1e-09", self.verify("out", "--all", "--tolerance", "1e-8", expect=0))

    def test_bad_input(self):
        self.run_study(STUDY)
        self.write("none.h5", "no HDF5")
        self.write("old.toml", edit(STUDY, ("4h", "5h")))
        for arguments, code, said in ((["nothing.h5"], 2, "nothing.h5: no such file"), (["none.h5"], 4, "not a readable"),
                                      (["out", "--sample", "0"], 2, "--sample"), (["out", "--tolerance", "2"], 2, "tolerance"),
                                      (["out", "--sample", "1", "--all"], 2, "--all")):
            with self.subTest(arguments):
                done = self.acstudy("verify", *arguments)
                self.assertEqual((done.returncode, done.stdout), (code, ""))
                self.assertIn(said, done.stderr)


if __name__ == "__main__":
    unittest.main()
