"""The name of a check: printed by explain, carried by its finding and by a JUnit test case, and no other's."""

from collections import Counter
import re
import unittest
import xml.etree.ElementTree as ET

from tests.program import ROOT, WIDE, ProgramTest

SCHEMES = """\
[scene]
use = "constant-velocity"

[[scheme]]
model = 1
kernel = "inverse"

[[scheme]]
model = 2
kernel = "cubic-spline"
mu = 1

[[scheme]]
model = 2
kernel = "cubic-spline"
mu = 2

"""
SWEEP = "[sweep]\nN = [16, 24]\nratios = [0.5, 2]\n"
STEPPING = '[time]\nintegrator = "ssprk3"\nstep = "h/4"\n'
CHEAP = {
    "stability": SCHEMES + SWEEP,
    "identities": SCHEMES + SWEEP + "horizons = [0.1, 0.2]\n",
    "consistency": SCHEMES + SWEEP + '[[path]]\nname = "delta = 2h"\ndelta = "2*h"\nN = [16, 24, 36, 54]\n'
                                     'source = "local"\n',
    "stability-map": SCHEMES + '[stability-map]\nN = 8\nratios = [0.5, 2]\ncfl = [0.5, 2]\n'
                               'integrators = ["forward-euler", "sdirk2"]\n[growth]\nratio = 2\ncfl = [0.9, 1.5]\n',
    "map": SCHEMES + STEPPING + '[map]\ndelta = [0.01, 0.02, 0.05, 0.1]\nN = [12, 16, 24, 32]\n'
                                'sources = ["local", "nonlocal"]\n',
    "controls": SCHEMES + STEPPING + '[[path]]\nname = "delta = 2h"\ndelta = "2*h"\nN = [12, 16, 24, 32]\n'
                                     'source = "local"\n[[consistency]]\nname = "fine"\ndelta = "2*h"\nN = [16, 24]\nsource = "local"\n[[control]]\nname = "downwind"\n'
                                     'scheme = { model = 1, kernel = "inverse" }\n',
    "digits": '[[weights]]\nmodel = 2\nkernel = "cubic-spline"\n[digits]\nratios = [0.5, 2.5]\n',
    "corpus": "",
    "convergence": None,
}


def names_of(explained):
    """The names of the checks that explain prints: a line each, or the head of a series' table."""
    if series := re.findall(r"^(\S.*), source (?:local|nonlocal|given)$", explained, re.MULTILINE):
        return series
    return re.findall(r"^  (.+)$", explained, re.MULTILINE)


def repeated(names):
    return [name for name, count in Counter(names).items() if count > 1]


class Names(ProgramTest):
    def names(self, *files):
        done = self.acstudy("explain", *files)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return names_of(done.stdout)

    def test_no_study_prints_a_name_twice(self):
        files = sorted([*(ROOT / "studies").glob("*.toml"), *(ROOT / "studies" / "deep").glob("*.toml")])
        self.assertGreater(len(files), 30)
        for file in files:
            with self.subTest(file.name):
                names = self.names(file)
                self.assertGreater(len(names), 0)
                self.assertEqual(repeated(names), [])

    def test_names_that_are_repeated_are_seen(self):
        text = "a study - of two (stability)\n\n  Lemma 1: here; there\n  Lemma 1: here; there\n"
        self.assertEqual(repeated(names_of(text)), ["Lemma 1: here; there"])

    def test_findings_and_junit_have_the_names_of_explain_in_its_order(self):
        for kind, tables in CHEAP.items():
            with self.subTest(kind):
                text = WIDE if tables is None else f'[study]\nname = "tiny"\nkind = "{kind}"\n{tables}'
                self.run_study(text, "--fresh")
                explained = self.names("tiny.toml")
                result = self.result()
                if tables is None:
                    self.assertEqual(len(result["series"]), len(explained))
                else:
                    found = [f"{one['statement']}: {one['subject']}; {one['check']}" for one in result["findings"]]
                    self.assertEqual(found, explained)
                    self.assertTrue(all(one["coordinates"] for one in result["findings"]))
                self.acstudy("check", "out/tiny.json", "--junit", "gates.xml")
                cases = ET.parse(self.folder / "gates.xml").getroot().iter("testcase")
                self.assertEqual([case.get("name") for case in cases], explained)
                self.assertEqual(repeated(explained), [])

    def test_two_checks_of_one_name_are_refused(self):
        path = '[[path]]\nname = "delta = 2h"\ndelta = "2*h"\nN = [16, 24, 36, 54]\nsource = "local"\n'
        head = f'[study]\nname = "tiny"\nkind = "consistency"\n{SCHEMES}{SWEEP}{path}'
        self.write("tiny.toml", head + path.replace("54", "64"))
        self.assert_bad_input(self.acstudy("explain", "tiny.toml"),
                              'tiny.toml: two checks have the name "Lemma 2.5: Model I, inverse; jittered, delta = 2h"; '
                              "leave one of them out, or give its path another name")
        # Another horizon tells them apart, whatever the path is called.
        self.write("tiny.toml", head + path.replace("2*h", "3*h"))
        self.assertIn("Lemma 2.5: Model I, inverse; jittered, delta = 2h, 3*h", self.names("tiny.toml"))


if __name__ == "__main__":
    unittest.main()
