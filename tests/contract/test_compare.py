"""acstudy compare: what differs between two sets of results, for people and for programs."""

import copy
import json
import math
import shutil
import unittest

from tests.program import GOOD, UNSOLVED, WIDE, ProgramTest, edit, strict_json

TWO = GOOD + GOOD[GOOD.index("[[path]]"):].replace("delta = 4h", "delta = 2h").replace("4*h", "2*h")
NAME = "Model I, local divergence, inverse, delta = "
IDENTITIES = """\
[study]
name = "tiny"
title = "Identities"
kind = "identities"

[scene]
use = "lee-du-2019"

[[scheme]]
model = 1
divergence = "local"
kernel = "inverse"

[sweep]
N = [16, 32]
ratios = [2]
"""


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        self.run_study(TWO, out="old", expect=0)

    def new(self, *changes, study="tiny"):
        """Makes new/ the same as old/ but for the changes of the JSON file, each given the whole of it."""
        shutil.rmtree(self.folder / "new", ignore_errors=True)
        shutil.copytree(self.folder / "old", self.folder / "new")
        result = self.result(study, out="old")
        result.pop("checksum", None)  # what is changed on purpose is not damaged
        for change in changes:
            change(result)
        (self.folder / "new" / f"{study}.json").write_text(json.dumps(result), encoding="utf-8")

    def compare(self, *arguments, expect, old="old", new="new"):
        """The text, and what the JSON object says; exit codes are alike."""
        text, said = self.acstudy("compare", old, new, *arguments), self.acstudy("compare", old, new, "--json")
        for done in (text, said):
            self.assertEqual((done.returncode, done.stderr), (expect, ""), done.stdout)
        for line in text.stdout.splitlines():
            self.assertLessEqual(len(line), 80, line)
            self.assertEqual(line, line.rstrip())
        return text.stdout, strict_json(said.stdout)

    def changes(self, said):
        return {finding["name"]: finding["change"] for study in said["studies"] for finding in study["findings"]}

    def test_the_same_is_identical(self):
        self.new()
        text, said = self.compare(expect=0)
        lines = text.splitlines()
        self.assertEqual(lines[0], "0 of 2 verdicts worsened, 0 improved, 0 changed otherwise")
        self.assertRegex(lines[1], r"\Abitwise equal: errors in 8 of 8 cases, (\d+) of \1 counts of work\Z")
        self.assertEqual(lines[2], "in total NEW/OLD: pairs 1, seconds 1 (for information)")
        self.assertEqual(lines[4][:23], "OLD  old: 1 study of 20")
        self.assertLess(len(lines), 12)
        self.assertEqual((said["format"], said["identical"], said["worsened"]), ("acstudy-compare-1", True, False))
        self.assertEqual(said["provenance_that_differs"], {})
        self.assertEqual(self.changes(said), {NAME + "4h": "unchanged", NAME + "2h": "unchanged"})

    def test_both_forms_of_a_file_say_the_same(self):
        for study in (TWO, WIDE, UNSOLVED, IDENTITIES):
            with self.subTest(study[:200]):
                shutil.rmtree(self.folder / "old")
                self.run_study(study, out="old")
                for old, new in (("json", "h5"), ("h5", "json"), ("h5", "h5")):
                    _, said = self.compare(old=f"old/tiny.{old}", new=f"old/tiny.{new}", expect=0)
                    self.assertTrue(said["identical"], json.dumps(said)[:2000])
                    numbers = said["numbers"]
                    self.assertGreater(numbers["errors"]["all"] + numbers["values"]["all"], 1)

    def test_a_verdict_that_worsened(self):
        def worse(result):
            series = result["series"][1]
            series["verdict"] = "below"
            series["observed"].update(order=0.61, low=0.55, high=0.7)
            series["reason"] = "because " * 20 + "so"

        self.new(worse)
        text, said = self.compare(expect=1)
        lines = text.splitlines()
        self.assertEqual(lines[0], "1 of 2 verdicts worsened, 0 improved, 0 changed otherwise")
        at = lines.index("worsened")
        self.assertEqual(lines[at + 1], f"  tiny: {NAME}2h")
        self.assertRegex(lines[at + 2], r"\A    OLD  confirmed       \d\.\d\d \[.*\]\Z")
        self.assertEqual(lines[at + 3], "    NEW  below           0.61 [0.55, 0.70], expected confirmed")
        self.assertEqual(lines[at + 4], "    NEW/OLD: errors equal, pairs 1, seconds 1")
        self.assertEqual(lines[at + 5:at + 7], ["    " + " ".join(["because"] * 9), "    " + " ".join(["because"] * 9) + " ..."])
        self.assertIn("because " * 9 + "so", " ".join(self.compare("-v", expect=1)[0].split()))
        self.assertEqual(self.changes(said), {NAME + "4h": "unchanged", NAME + "2h": "worsened"})
        finding = said["studies"][0]["findings"][1]
        self.assertEqual((finding["old"]["verdict"], finding["new"]["verdict"], finding["new"]["low"]),
                         ("confirmed", "below", 0.55))
        self.assertEqual((finding["old"]["as_expected"], finding["new"]["as_expected"]), (True, False))
        text, said = self.compare(expect=0, old="new", new="old")
        self.assertIn(f"\nchanged otherwise\n  tiny: {NAME}2h: improved\n", text)
        self.assertEqual(self.changes(said)[NAME + "2h"], "improved")
        text, said = self.compare(expect=0, old="new", new="new")  # it departs in both
        self.assertTrue(said["identical"])

    def test_another_verdict_as_right_is_no_worse(self):
        self.new(lambda result: result["series"][0].update(verdict="pre-asymptotic"))
        text, said = self.compare(expect=0)
        self.assertIn("0 of 2 verdicts worsened, 0 improved, 1 changed otherwise\n", text)
        self.assertIn(f"\n  tiny: {NAME}4h: verdict changed\n", text)
        self.assertFalse(said["identical"])

    def test_the_last_bit_of_an_error(self):
        def bit(result):
            case = result["series"][0]["cases"][2]
            case["error_linf"] = math.nextafter(case["error_linf"], 1.0)

        self.new(bit)
        text, said = self.compare(expect=0)
        self.assertIn("\nbitwise equal: errors in 7 of 8 cases, ", text)
        self.assertRegex(text, r"\n  tiny +7/8  1 to 1\+[12]e-16 +1 +1\n")
        self.assertRegex(" ".join(text.split()), "nothing that decides a run differs, and")
        self.assertFalse(said["identical"])
        cases = said["studies"][0]["findings"][0]["cases"]
        self.assertEqual([case["differ"] for case in cases], [[], [], ["error_linf"], []])
        error = cases[2]["error_linf"]
        self.assertGreater(error["new"], error["old"])
        self.assertEqual(error["ratio"], error["new"] / error["old"])

    def test_work_and_seconds(self):
        def slower(result):
            for series in result["series"]:
                for case in series["cases"]:
                    case["seconds"] *= 3

        self.new(slower)
        text, said = self.compare(expect=0)
        self.assertTrue(said["identical"])  # times are never the same
        self.assertAlmostEqual(said["numbers"]["seconds"]["ratio"], 3)
        self.new(slower, lambda result: result["series"][0]["cases"][0]["work"].update(pairs=7))
        text, said = self.compare(expect=0)
        self.assertFalse(said["identical"])
        self.assertRegex(text, r"\n  tiny +8/8  equal +0\.\d+ +3\n")
        case = said["studies"][0]["findings"][0]["cases"][0]
        self.assertEqual((case["differ"], case["work_pairs"]["new"]), (["work_pairs"], 7))

    def test_numbers_that_are_no_errors(self):
        self.new(lambda result: result["series"][0]["cases"][0].update(dt=0.125, dt_smallest=0.125))
        text, said = self.compare(expect=0)
        self.assertRegex(text, r"\n  tiny +8/8  equal +1 +1\n    2 of \d+ orders, steps, counts and other norms differ\n")
        self.assertEqual(said["studies"][0]["findings"][0]["cases"][0]["differ"], ["dt", "dt_smallest"])

    def test_orders_side_by_side(self):
        self.new(lambda result: result["series"][0]["observed"].update(order=1.25, low=1.2, high=1.3))
        text, said = self.compare(expect=0)
        self.assertRegex(text, r"\norders that moved, the verdict being the same\n"
                         rf"  tiny: {NAME}4h\n    OLD \d.* \[.*\], NEW 1\.25 \[1\.20, 1\.30\], outside")
        self.assertEqual(said["numbers"]["orders"], {"all": 6, "equal": 3, **{
            name: said["numbers"]["orders"][name] for name in ("lowest_ratio", "highest_ratio", "without_ratio")}})

    def test_another_expectation(self):
        """Loosened, it cannot hide that a verdict worsened; where both are met it is only said."""
        self.new(lambda result: result["series"][0].update(expected="stable"))
        text, said = self.compare(expect=0)
        self.assertEqual(self.changes(said)[NAME + "4h"], "expectation changed")
        self.assertIn("    expected: OLD confirmed, NEW stable\n", text)
        self.new(lambda result: result["series"][0].update(expected="stable", verdict="below"))
        text, said = self.compare(expect=1)
        self.assertEqual(self.changes(said)[NAME + "4h"], "worsened")
        self.assertIn("it does not meet what was expected before", text)
        self.new(lambda result: result["series"][0].update(expected="above"))  # what it never was
        text, said = self.compare(expect=1)
        self.assertIn("expected above", text)

    def test_what_failed_or_was_interrupted(self):
        self.new(lambda result: result["series"][0]["cases"][1].update(failure="singular matrix"))
        text, _ = self.compare(expect=1)
        self.assertIn("    it failed numerically: singular matrix\n", text)
        self.new(lambda result: result["series"][0].update(cases_planned=5))
        text, _ = self.compare(expect=1)
        self.assertIn("    4 of 5 cases; the run was interrupted\n", text)

    def test_a_study_that_was_interrupted(self):
        self.run_study(IDENTITIES, out="old", expect=0)
        self.new(lambda result: result["findings"].pop())
        text, said = self.compare(expect=1)
        self.assertRegex(text, r"\nworsened\n  tiny: \d+ of \d+ findings; the run was interrupted\n")
        self.assertIn("interrupted", said["studies"][0]["worsened"])
        self.new(lambda result: result["findings"].pop(), lambda result: result.update(
            findings_planned=len(result["findings"])))  # less was asked for
        text, said = self.compare(expect=0)
        self.assertIn("\nin one only\n  OLD: tiny: ", text)
        self.assertEqual(list(self.changes(said).values()).count("only in OLD"), 1)

    def test_what_is_in_one_only(self):
        self.write("other.toml", edit(GOOD, ('"tiny"', '"other"')))
        self.assertEqual(self.acstudy("run", "other.toml", "--out", "old").returncode, 0)
        self.new(lambda result: result["series"].pop(0), lambda result: result["series"][0]["cases"].pop(0),
                 lambda result: result["series"][0].update(cases_planned=3))
        for name in ("json", "h5"):
            (self.folder / "new" / f"other.{name}").unlink()
        text, said = self.compare(expect=0)
        self.assertIn(f"\nin one only\n  OLD: 1 study: other\n  OLD: tiny: {NAME}4h\n", text)
        self.assertEqual([study["in"] for study in said["studies"]], ["old", "both"])
        finding = said["studies"][1]["findings"][1]
        self.assertEqual([case["in"] for case in finding["cases"]], ["old", "both", "both", "both"])
        self.assertEqual(said["numbers"]["only_in_old"], 1)
        self.assertFalse(said["identical"])
        text, said = self.compare(expect=0, old="new", new="old")
        self.assertIn("\nin one only\n  NEW: 1 study: other\n", text)

    def test_findings_are_known_by_their_coordinates(self):
        """Another name is another thing only if nothing else tells which it is."""
        def renamed(result):
            result["series"][0].update(statement="Theorem 9", path="delta = 4 h")

        self.new(renamed)
        _, said = self.compare(expect=0)
        self.assertEqual(set(self.changes(said).values()), {"unchanged"})
        self.new(lambda result: [series.pop("coordinates") for series in result["series"]])  # as in older files
        _, said = self.compare(expect=0)
        self.assertTrue(said["identical"])
        self.new(renamed, lambda result: [series.pop("coordinates") for series in result["series"]])
        _, said = self.compare(expect=0)
        self.assertEqual(sorted(self.changes(said).values()), ["only in NEW", "only in OLD", "unchanged"])

    def test_where_both_come_from_is_said(self):
        self.new(lambda result: result["provenance"].update(compiler="GNU 99", version="0.1.0+abc"),
                 lambda result: result["series"][0]["cases"][0].update(error_l2=0.5))
        text, said = self.compare(expect=0)
        said_in_text = " ".join(text.split())
        self.assertRegex(said_in_text, r"compiler: OLD \S+ [\d.]+, NEW GNU 99 ")
        self.assertIn("NEW 0.1.0+abc", said_in_text)
        self.assertIn("numbers differ because of compiler, or of the study files", said_in_text)
        self.assertEqual(said["provenance_that_differs"]["compiler"]["new"], ["GNU 99"])
        self.assertEqual(set(said["provenance_that_differs"]), {"compiler", "version"})

    def test_many_differences_stay_on_a_screen(self):
        def many(count, verdict):
            def change(result):
                one = result["series"][0]
                result["series"] = []
                for i in range(count):
                    other = copy.deepcopy(one)
                    other.update(path=f"path {i}", verdict=verdict if i % 2 else "pre-asymptotic")
                    other["coordinates"]["path"] = other["path"]
                    for case in other["cases"]:
                        case["error_linf"] *= 1.5 if verdict == "below" else 1
                    if i % 2 == 0 and verdict == "below":
                        other["observed"]["order"] += 0.01 * i
                    result["series"].append(other)
                result["series"].append(dict(one, path=verdict, coordinates=dict(one["coordinates"], path=verdict)))
            return change

        self.new(many(30, "confirmed"))
        shutil.rmtree(self.folder / "old")
        (self.folder / "new").rename(self.folder / "old")
        self.new(many(30, "below"))
        text, _ = self.compare(expect=1)
        self.assertLessEqual(len(text.splitlines()), 40, text)
        self.assertRegex(text, r"\n  and 1\d more; -v shows all\n")
        everything, _ = self.compare("-v", expect=1)
        self.assertEqual(everything.count("expected confirmed"), 15)
        self.assertNotIn("more; -v", everything)

        def everything_else(result):
            many(30, "below")(result)
            result["series"][4]["verdict"] = "confirmed"
            for name in ("version", "numerics", "compiler", "flags", "libraries", "machine", "vectors", "system"):
                result["provenance"][name] = " ".join([f"another {name}"] * 8)

        self.new(everything_else)
        text, _ = self.compare(expect=1)
        for heading in ("worsened", "changed otherwise", "in one only", "orders that moved", "studies whose numbers"):
            self.assertIn(f"\n\n{heading}", text)
        self.assertIn("expected confirmed", text, "the worst is shown, however little room there is")
        self.assertLessEqual(len(text.splitlines()), 40, text)

    def test_files_that_are_no_results(self):
        self.new()
        self.write("notes.txt", "x")
        (self.folder / "empty").mkdir()
        for name, message in (
                ("none", "none: no such file or folder; name a result file, or the folder that holds some"),
                ("notes.txt", "notes.txt: a result file ends in .json or .h5; name one, or the folder that holds some"),
                ("tiny.toml", "tiny.toml: a result file ends in .json or .h5; name one, or the folder that holds some"),
                ("empty", "empty: no result file (.json, .h5) in the folder; name the one that acstudy run has written to")):
            with self.subTest(name):
                self.assert_bad_input(self.acstudy("compare", name, "new"), message)
                self.assert_bad_input(self.acstudy("compare", "old", name, "--json"), message)
        self.assertEqual(self.acstudy("compare", "old").returncode, 2)
        self.assertEqual(self.acstudy("compare", "old", "new", "new").returncode, 2)

    def test_hostile_json(self):
        good = self.result(out="old")
        del good["checksum"]
        hostile = {"list": "[]", "nothing": "", "half": json.dumps(good)[:500], "no JSON": '{"study": NaN}',
                   "study": json.dumps(dict(good, study=5)), "series": json.dumps(dict(good, series="x")),
                   "numbers": json.dumps(dict(good, series=[1, 2])), "deep": "[" * 100000,
                   "provenance": json.dumps(dict(good, provenance=[1])),
                   "planned": json.dumps(dict(good, findings=[], findings_planned="many"))}
        for name, value in (("verdict", "fine"), ("verdict", None), ("observed", 3), ("coordinates", {"path": []}),
                            ("cases", {"N": 1}), ("cases", [[]]), ("pairwise", 0)):
            result = copy.deepcopy(good)
            result["series"][0][name] = value
            if name != "pairwise":
                hostile[f"{name} = {value}"] = json.dumps(result)
        for name, text in hostile.items():
            self.write("hostile.json", text)
            with self.subTest(name):
                done = self.acstudy("compare", "old", "hostile.json")
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
                self.assertRegex(done.stderr, r"\Aacstudy: hostile.json: (not|cannot read) ")

    def test_what_a_file_says_does_not_steer_the_terminal(self):
        def hostile(result):
            result["series"][0].update(verdict="below", path="a\x1b[2J\nb", reason="\x1b]0;title\x07 \x7f")
            result["provenance"]["version"] = "\x1b[31m"

        self.new(hostile)
        text, _ = self.compare("-v", expect=1)
        self.assertNotRegex(text, r"[\x00-\x09\x0b-\x1f\x7f]")
        self.assertIn("    ?]0;title? ?\n", text)
        self.assertIn(", NEW ?[31m\n", text)

    def test_two_findings_or_studies_that_cannot_be_told_apart(self):
        self.new(lambda result: result["series"].append(result["series"][0]))
        done = self.acstudy("compare", "old", "new")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn(f'study "tiny" has two findings that cannot be told apart, "{NAME}4h"', done.stderr)
        self.new()
        shutil.copy(self.folder / "new" / "tiny.json", self.folder / "new" / "again.json")
        self.assert_bad_input(self.acstudy("compare", "old", "new"), 'new/tiny.json: study "tiny" is also in '
                              "new/again.json; move one of them away")

    def test_nothing_in_common(self):
        self.new(lambda result: result.update(study="other"))
        self.assert_bad_input(self.acstudy("compare", "old", "new"), "old and new have no verdict in common, so there is "
                              'nothing to compare: one is of "tiny", the other of "other"; name results of the same studies')

    def test_files_that_cannot_be_read(self):
        self.new()
        self.write("broken.h5", b"\x89HDF\r\n\x1a\n" + bytes(100))
        done = self.acstudy("compare", "old", "broken.h5")
        self.assertEqual((done.returncode, done.stdout), (4, ""))
        self.assertTrue(done.stderr.startswith("acstudy: broken.h5: not a readable result file ("), done.stderr)
        shutil.copy(self.folder / "old" / "tiny.json", self.folder / "renamed.h5")
        self.assertEqual(self.acstudy("compare", "old", "renamed.h5").returncode, 4)

    def test_of_a_folder_each_study_is_read_once(self):
        self.new()
        (self.folder / "new" / "tiny.json").unlink()
        self.write("new/bench.json", "{}")
        self.write("new/tiny.journal", "x")
        self.write("new/.hidden.json", "x")
        _, said = self.compare(expect=0)
        self.assertTrue(said["identical"])


if __name__ == "__main__":
    unittest.main()
