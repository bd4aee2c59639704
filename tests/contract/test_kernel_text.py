"""Kernels that a study writes: in every kind, in both models, in the store and in what is printed."""

import unittest

from tests.contract.test_keys import STUDIES, of_kind
from tests.program import ProgramTest, edit

TEXT = '{ profile = "(1-s)^3*(1+3*s)" }'
LABEL = "rho = (1-s)^3*(1+3*s)"
STUDY = """[study]
name = "tiny"

[scene]
use = "lee-du-2019"

[[scheme]]
model = 2
divergence = "nonlocal"
kernel = KERNEL

[time]
integrator = "forward-euler"
step = "h/8"

[[path]]
name = "delta = 4h"
delta = "4*h"
N = [320, 640, 1280, 2560]
source = "local"

[[path]]
name = "delta = 0.2"
delta = "0.2"
N = [160, 320, 640, 1280]
source = "nonlocal"
"""


def errors(result):
    return [[case["error_linf"] for case in series["cases"]] for series in result["series"]]


class KernelText(ProgramTest):
    def test_a_study_of_the_paper_is_confirmed_with_a_text_and_stored_by_it(self):
        self.assert_counts(self.run_study(edit(STUDY, ("KERNEL", TEXT)), expect=0), 8, 0)
        result = self.result()
        self.assertEqual({(series["kernel"], series["verdict"]) for series in result["series"]}, {(LABEL, "confirmed")})
        spaced = edit(STUDY, ("KERNEL", TEXT.replace("*", " * ")))
        self.assert_counts(self.run_study(spaced, expect=0), 0, 8)
        other = edit(STUDY, ("KERNEL", TEXT.replace("3*s", "2*s")))
        self.assert_counts(self.run_study(other, expect=0), 8, 0)
        self.assertNotEqual(errors(self.result()), errors(result))
        self.run_study(edit(STUDY, ("KERNEL", '"wendland-c2"')), expect=0)
        self.assertEqual(errors(self.result()), errors(result))

    def test_each_kind_takes_a_text(self):
        self.write("other.toml", STUDIES["convergence"])
        for kind, text in STUDIES.items():
            if "kernel = " not in text:
                continue
            with self.subTest(kind):
                text = text.replace('kernel = "cubic-spline"', f"kernel = {TEXT}").replace('"inverse"', TEXT)
                self.write("study.toml", of_kind(kind, text.replace('"cubic-spline"', f'"{LABEL}"')))
                done = self.acstudy("explain", "study.toml")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn(LABEL, done.stdout)

    def test_kernels_are_drawn(self):
        listed = self.acstudy("list", "kernels").stdout.splitlines()
        drawn = self.acstudy("list", "kernels", "--draw").stdout.splitlines()
        self.assertEqual(drawn[::2], listed)
        pictures = dict(zip((line.split("  ")[0] for line in drawn[::2]), (line[36:] for line in drawn[1::2])))
        self.assertEqual(pictures['"constant"'], 40 * "\N{FULL BLOCK}")
        self.assertTrue(all(len(picture) == 40 for picture in pictures.values()))
        self.assertGreater(len(set(pictures.values())), 8)
        done = self.acstudy("list", "scenes", "--draw")
        self.assertEqual((done.returncode, done.stdout), (2, ""))


if __name__ == "__main__":
    unittest.main()
