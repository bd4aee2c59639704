"""acstudy check where a machine reads it: JUnit XML and GitHub annotations."""

import json
import os
import re
import unittest
import xml.etree.ElementTree as ET

from tests.program import STUDY, ProgramTest, edit

# Particles at rest in the flow of a smooth solution: first order from the coarsest level on.
GOOD = edit(STUDY, ('"lee-du-2019"', '"lagrangian"'), ("[16, 32, 64]", "[32, 64, 128, 256]"))
TWO = GOOD + GOOD[GOOD.index("[[path]]"):].replace("delta = 4h", "delta = 2h").replace("4*h", "2*h")
NAME = "Model I, local divergence, inverse, delta = "


def stagnating(series):
    for case in series["cases"]:
        case["error_linf"] = 0.1


class MachineReadable(ProgramTest):
    def setUp(self):
        super().setUp()
        self.run_study(TWO, expect=0)

    def check(self, *files, expect, change=None):
        """Runs check on the result, its second series changed, and returns what it printed and the JUnit root."""
        if change:
            result = self.result()
            change(result["series"][1])
            (self.folder / "out" / "tiny.json").write_text(json.dumps(result), encoding="utf-8")
        done = self.acstudy("check", "-v", "out/tiny.json", *files, "--junit", "gates.xml", "--github")
        self.assertEqual((done.returncode, done.stderr), (expect, ""), done.stdout)
        return done.stdout, ET.parse(self.folder / "gates.xml").getroot()

    def assert_counts_match(self, root):
        for suites in (root, *root.iter("testsuite")):
            self.assertEqual(int(suites.get("tests")), len(list(suites.iter("testcase"))))
            self.assertEqual(int(suites.get("failures")), len(list(suites.iter("failure"))))
            self.assertEqual(suites.get("errors"), "0")

    def test_what_passes_is_in_junit_and_no_annotation(self):
        said, root = self.check(expect=0)
        self.assert_counts_match(root)
        self.assertEqual((root.tag, root.get("tests"), root.get("failures")), ("testsuites", "2", "0"))
        suite, = root
        self.assertEqual((suite.tag, suite.get("name")), ("testsuite", "tiny"))
        self.assertEqual([(case.get("classname"), case.get("name"), len(case)) for case in suite],
                         [("tiny", NAME + "4h", 0), ("tiny", NAME + "2h", 0)])
        self.assertNotIn("::", said)
        self.assertTrue(said.endswith("\n2 gates, 0 depart\n"), said)
        self.assertEqual(said.splitlines()[0].split(), ["gate", "study", "name", "observed", "verdict"])

    def test_a_tampered_file_is_a_failure_in_both(self):
        said, root = self.check(expect=1, change=stagnating)
        self.assert_counts_match(root)
        failing, = [case for case in root.iter("testcase") if len(case)]
        self.assertEqual(failing.get("name"), NAME + "2h")
        failure, = failing
        self.assertEqual((failure.tag, failure.get("type")), ("failure", "stagnates"))
        annotation = said.splitlines()[-1]
        head = "::error file=out/tiny.json,title=tiny%3A Model I%2C local divergence%2C inverse%2C delta = 2h::"
        self.assertTrue(annotation.startswith(head), annotation)
        message = annotation[len(head):]
        self.assertRegex(message, r"\Astagnates, expected confirmed: the file says confirmed, but .+")
        self.assertEqual(failure.get("message"), message)
        self.assertIn(message, failure.text)
        self.assertEqual(said.count("::error"), 1)
        self.assertIn("\n2 gates, 1 depart\n", said)

    def test_names_survive(self):
        name = "a & b < c > d \"e\" 'f' 100% δ, g: h\ti"
        said, root = self.check(expect=1, change=lambda series: (stagnating(series), series.update(path=name)))
        self.assertEqual([case.get("name") for case in root.iter("testcase") if len(case)],
                         [f"Model I, local divergence, inverse, {name}"])
        annotation, = re.findall(r"^::error .*title=(.*?)::", said, re.M)
        for escape, character in (("%2C", ","), ("%3A", ":"), ("%25", "%")):
            self.assertIn(escape, annotation)
            annotation = annotation.replace(escape, character)
        self.assertEqual(annotation, f"tiny: Model I, local divergence, inverse, {name}")

    def test_a_suite_per_study(self):
        self.write("other.toml", edit(GOOD, ('"tiny"', '"other"')))
        self.assertEqual(self.acstudy("run", "other.toml", "--out", "out").returncode, 0)
        _, root = self.check("out/other.json", expect=0)
        self.assert_counts_match(root)
        self.assertEqual([(suite.get("name"), suite.get("tests")) for suite in root], [("tiny", "2"), ("other", "1")])

    def test_without_options_there_is_neither(self):
        before = sorted(os.listdir(self.folder))
        self.check(expect=1, change=stagnating)
        os.remove(self.folder / "gates.xml")
        done = self.acstudy("check", "out/tiny.json")
        self.assertEqual(done.returncode, 1)
        self.assertNotIn("::error", done.stdout)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_the_file_is_replaced_as_a_whole(self):
        self.write("gates.xml", "old" * 10000)
        self.check(expect=0)
        self.assertEqual([name for name in os.listdir(self.folder) if "partial" in name or name.startswith(".")], [])

    def test_an_unwritable_file_is_bad_input_before_anything_else(self):
        for file, why in (("none/gates.xml", "No such file or directory"),
                          ("out/tiny.json/gates.xml", "Not a directory"),
                          ("out", "there is something that is no regular file"),
                          ("/dev/null", "there is something that is no regular file"),
                          ("out/", "it has no name"),
                          ("out/tiny.json", "a result file has such a name")):
            with self.subTest(file):
                # the result file is not there either, and is not asked for
                self.assert_bad_input(self.acstudy("check", "none.json", "--junit", file, "--github"),
                                      f"{file}: cannot write the JUnit file: {why}; name another one with --junit")

    def test_bad_results_leave_the_old_file(self):
        self.write("gates.xml", "old")
        self.assertEqual(self.acstudy("check", "none.json", "--junit", "gates.xml").returncode, 2)
        self.assertEqual((self.folder / "gates.xml").read_text(encoding="utf-8"), "old")


if __name__ == "__main__":
    unittest.main()
