"""Bad input: the complete message, exit code 2, and nothing run or written."""

import unittest

from tests.bad_studies import DELTA, DIGITS
from tests.program import FIELDS, INLINE, MODEL_II, STUDY, UNSOLVED, USE, ProgramTest, edit


class BadStudy(ProgramTest):
    def test_explain_says_the_same(self):
        for change, place in ((("model = 1", "model = 3"), '9:9: model = 3; it must be 1 or 2 or "slopes" or "symmetric"'),
                              (('title = "A tiny study"\n', "grid = 3\n"),
                               '3:1: unknown key "grid" in [study]; known keys: name, title, kind')):
            self.write("bad.toml", edit(STUDY, change))
            self.assert_bad_input(self.acstudy("explain", "bad.toml"), f"bad.toml:{place}")

    def test_the_studies_that_the_mistakes_are_made_in_are_good(self):
        for text in (STUDY, INLINE, UNSOLVED, DIGITS, edit(STUDY, MODEL_II), edit(INLINE, (FIELDS, USE))):
            self.write("good.toml", text)
            done = self.acstudy("explain", "good.toml")
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_what_is_not_toml_is_said_with_its_place(self):
        for text, place in ((edit(STUDY, ("model = 1", "model = ")), "9:9"),
                            (edit(STUDY, (DELTA, '"4*h')), "19:13"),
                            (b"\xff" + STUDY.encode(), "1:1")):
            with self.subTest(place):
                self.write("bad.toml", text)
                done = self.acstudy("run", "bad.toml", "--out", "out")
                # What follows is the parser's own sentence.
                self.assertRegex(done.stderr, rf"\Aacstudy: bad\.toml:{place}: not TOML: [^\n]+\n\Z")
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertFalse((self.folder / "out").exists())

    def test_line_breaks_in_names_do_not_break_the_message(self):
        for change in (('"tiny"', r'"ti\nny"'), (USE, r'use = "a\nb"'), (DELTA, r'"4*h\n + k"'),
                       ("title =", r'"a\nb" =')):
            with self.subTest(change):
                self.write("bad.toml", edit(STUDY, change))
                done = self.acstudy("run", "bad.toml", "--out", "out")
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)

    def test_windows_line_ends_and_a_byte_order_mark_are_no_mistake(self):
        self.write("good.toml", b"\xef\xbb\xbf" + STUDY.replace("\n", "\r\n").encode())
        self.assertEqual(self.acstudy("explain", "good.toml").returncode, 0)


class BadFile(ProgramTest):
    def assert_nothing_written(self):
        self.assertFalse((self.folder / "out").exists())

    def test_a_study_file_that_cannot_be_read(self):
        (self.folder / "folder").mkdir()
        self.write("good.toml", STUDY)
        self.write("empty.toml", "")
        for name, why in (("missing.toml", "cannot read the study file; name an existing, non-empty file"),
                          ("empty.toml", "cannot read the study file; name an existing, non-empty file"),
                          ("folder", "a folder; name its study files: folder/*.toml"),
                          ("folder/", "a folder; name its study files: folder/*.toml")):
            for files in ((name,), ("good.toml", name)):
                for arguments in (("run", *files, "--out", "out"), ("explain", *files)):
                    with self.subTest(arguments):
                        self.assert_bad_input(self.acstudy(*arguments), f"{name}: {why}")
        self.assert_nothing_written()

    def test_one_bad_study_stops_all(self):
        self.write("good.toml", STUDY)
        self.write("bad.toml", edit(STUDY, ('"tiny"', '"other"'), ("model = 1", "model = 3")))
        self.assert_bad_input(self.acstudy("run", "good.toml", "bad.toml", "--out", "out"),
                              'bad.toml:9:9: model = 3; it must be 1 or 2 or "slopes" or "symmetric"')
        self.assert_nothing_written()

    def test_two_studies_of_one_name(self):
        self.write("one.toml", STUDY)
        self.write("two.toml", STUDY)
        for second in ("two.toml", "one.toml"):
            self.assert_bad_input(
                self.acstudy("run", "one.toml", second, "--out", "out"),
                f'{second}: a second study named "tiny"; it would overwrite the results of the first')
        self.assert_nothing_written()

    def test_an_output_folder_below_a_file(self):
        self.write("good.toml", STUDY)
        self.write("file", "kept")
        for out in ("file", "file/out"):
            self.assert_bad_input(
                self.acstudy("run", "good.toml", "--out", out),
                f"{out}: cannot write to the output folder: Not a directory; name another one with --out")
        self.assertEqual((self.folder / "file").read_text(encoding="utf-8"), "kept")

    def test_a_result_file_that_is_none(self):
        (self.folder / "folder").mkdir()
        remedy = "name a .json file that acstudy run has written"
        for name, text, said in (
                ("none.json", None, f"cannot read the result file; {remedy}"),
                ("folder", None, r"a folder; name its result files: folder/\*\.json"),
                ("text.json", "[study]", f"not JSON, from byte 2 on; {remedy}"),
                ("half.json", '{"study": "tiny", "series": [', f"not JSON, from byte 30 on; {remedy}"),
                ("empty.json", "", f"cannot read the result file; {remedy}"),
                ("list.json", "[]", f"not a result file of acstudy: .+; {remedy}"),
                ("other.json", '{"study": "tiny"}', f"not a result file of acstudy: .*series.*; {remedy}"),
                ("no-series.json", '{"study": "tiny", "series": []}',
                 "the result file has no series, so there is nothing to check")):
            with self.subTest(name):
                if text is not None:
                    self.write(name, text)
                done = self.acstudy("check", name)
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertRegex(done.stderr, rf"\Aacstudy: {name}: {said}\n\Z")


class BadUsage(ProgramTest):
    # The sentences are the argument parser's; that they name the argument is ours to see.
    def test_one_line_that_names_the_argument(self):
        self.write("good.toml", STUDY)
        run = ("run", "good.toml", "--out", "out")
        for arguments, named in (((), "no command"), (("frobnicate",), "frobnicate"),
                                 (("--frobnicate",), "--frobnicate"),
                                 (("run",), "STUDY.toml"), (("check",), "FILE.json"), (("explain",), "STUDY.toml"),
                                 ((*run, "--jobs", "0"), "--jobs: Value 0"),
                                 ((*run, "--jobs", "-1"), "--jobs: Value -1"),
                                 ((*run, "--jobs", "1.5"), "1.5"), ((*run, "--jobs", "two"), "two"),
                                 ((*run, "--jobs", "1000000"), "1000000"), ((*run, "--jobs"), "--jobs"),
                                 ((*run, "--frobnicate"), "--frobnicate"), (("list", "colors"), "colors"),
                                 (("list", "scenes", "kernels"), "kernels")):
            with self.subTest(arguments):
                done = self.acstudy(*arguments)
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
                self.assertTrue(done.stderr.startswith("acstudy: "), done.stderr)
                self.assertRegex(done.stderr, r"; see acstudy (run |check |explain |list )?--help\n$")
                self.assertIn(named, done.stderr)
        self.assertEqual([file.name for file in self.folder.iterdir()], ["good.toml"])


if __name__ == "__main__":
    unittest.main()
