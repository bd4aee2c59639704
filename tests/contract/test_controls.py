"""Deliberate mistakes: the detection study passes its gate, an unnoticed mistake does not, and no scheme can be one."""

import os
import subprocess
import tempfile
import unittest

from tests.program import ACSTUDY, ROOT, STUDY, ProgramTest, edit

TINY = """\
[study]
name = "tiny"
kind = "controls"

[scene]
use = "lee-du-2019"

[time]
integrator = "forward-euler"
step = "h/8"

[[path]]
name = "delta = 4h"
delta = "4*h"
N = [20, 40, 80]
source = "local"

[[consistency]]
name = "delta = 4h"
delta = "4*h"
N = [100, 500, 2500, 12500]
source = "local"

[[scheme]]
model = 2
divergence = "local"
kernel = "cubic-spline"

[[control]]
name = "downwind"
scheme = { model = 1, divergence = "local", kernel = "inverse" }
"""
DOWNWIND = TINY[TINY.index('name = "downwind"'):]
COARSE = (("N = [20, 40, 80]", "N = [80, 160, 320, 640]"), ("N = [100, 500, 2500, 12500]", "N = [40, 80, 160, 320]"))


def control(text):
    return edit(TINY, (DOWNWIND, text))


# What is wrong: (the study, the message). The message points at the character behind the @.
STUDIES = {
    "a scheme that asks for a control": (
        edit(STUDY, ("model = 1\n", 'model = 1\n@control = "downwind"\n')),
        'unknown key "control" in [[scheme]]; known keys: model, divergence, kernel, limiter, mu, '
        'command, label, order, expect, timeout, inputs'),
    "controls with implicit steps": (
        edit(TINY, ('[time]\nintegrator = "forward-euler"', '@[time]\nintegrator = "backward-euler"')),
        'integrator = "backward-euler"; a control has no matrix to solve with: write an explicit one'),
    "controls by their rows": (
        edit(TINY, ('step = "h/8"', 'step = @"cfl"\nbound = "rows"')),
        'bound = "rows"; a control does not say what its rows need: leave bound out'),
    "controls with several ways to step": (
        edit(TINY, ("[time]", "@[[time]]")).replace(
            '[[path]]\nname', '[[time]]\nintegrator = "ssprk2"\nstep = "h"\n\n[[path]]\nname', 1),
        "a study of this kind steps in one way; leave one [[time]], and one tolerance where steps are adaptive"),
    "controls that expect something of their steps": (
        edit(TINY, ('[time]', '@[time]'), ('step = "h/8"', 'step = "h/8"\nexpect = "stable"')),
        "a study of this kind expects nothing of a way to step; leave expect out of it"),
    "a control with the wrong divergence": (
        control('name = "downwind"\nscheme = @{ model = 1, divergence = "nonlocal", kernel = "inverse" }\n'),
        "downwind is a mistake in Model I, local divergence; write scheme = "
        '{ model = 1, divergence = "local", ... }'),
    "a control of the other model": (
        control('name = "no viscosity"\nscheme = @{ model = 1, divergence = "local", kernel = "inverse" }\n'),
        "no viscosity is a mistake in Model II, local divergence; write scheme = "
        '{ model = 2, divergence = "local", ... }'),
    "an unknown check": (TINY + '[control.expect]\n@"delta = h" = "below"\n',
                         'unknown key "delta = h" in [expect]; known keys: delta = 4h, consistency, delta = 4h, '
                         'nearest neighbors, first moment, step norm, maximum principle, trajectories; did you mean "delta = 4h"?'),
    "an expectation of all rows": (
        edit(TINY, ('"4*h"\nN = [20, 40, 80]\n', '"4*h"\nN = [20, 40, 80]\nexpect = @"below"\n')),
        "a path of this kind of study has no expect; expectations stand in a table expect of their [[control]]"),
    "misprinted trajectories of another flow": (
        edit(control('name = "misprinted trajectories"\nscheme = { model = 1, kernel = "inverse" }\n'),
             ('use = "lee-du-2019"', 'use = "constant-velocity"'), ('divergence = "local"\n', ""),
             ("[[control]]", "@[[control]]")),
        'misprinted trajectories are those of b = sin(x); use the scene "lee-du-2019"'),
}


class Controls(ProgramTest):
    def test_the_detection_study_passes_its_gate(self):
        run = subprocess.run([ACSTUDY, "run", ROOT / "studies" / "controls.toml", "--out", self.folder], text=True,
                             capture_output=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout)
        check = self.acstudy("check", self.folder / "controls.json")
        self.assertEqual(check.returncode, 0, check.stdout)
        rows = [row for row in self.result("controls", out=".")["findings"] if row["check"] == "alarms"]
        self.assertGreaterEqual(len(rows), 25)
        for row in rows:
            alarms = row["points"][0]["value"]
            (self.assertEqual if row["subject"].startswith("Model") else self.assertGreater)(alarms, 0, row["subject"])

    def test_a_mistake_that_nothing_notices_departs(self):
        """One percent of the source is lost in the truncation error of few particles."""
        unnoticed = edit(control('name = "source off by 1 %"\n'
                                 'scheme = { model = 1, divergence = "local", kernel = "inverse" }\n'), *COARSE)
        self.run_study(unnoticed, expect=1)
        row = [row for row in self.result()["findings"] if row["subject"].startswith("source")][-1]
        self.assertEqual((row["check"], row["verdict"], row["as_expected"], row["points"][0]["value"]),
                         ("alarms", "violated", False, 0.0))
        self.assertEqual(self.acstudy("check", self.folder / "out" / "tiny.json").returncode, 1)

    def test_an_alarm_that_the_study_does_not_expect_departs(self):
        self.run_study(TINY, expect=1)
        found = {row["check"]: row for row in self.result()["findings"] if row["subject"].startswith("downwind")}
        self.assertTrue(found["step norm"]["alarm"] and not found["step norm"]["as_expected"])
        self.assertEqual(found["alarms"]["remark"], "looks to the side from which nothing comes")

    def test_bad_input(self):
        for what, (marked, message) in STUDIES.items():
            with self.subTest(what):
                before, text = marked.split("@")[0], marked.replace("@", "")
                line, column = before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1
                with tempfile.TemporaryDirectory() as self.folder:
                    self.write("bad.toml", text)
                    self.assert_bad_input(self.acstudy("run", "bad.toml", "--out", "out"),
                                          f"bad.toml:{line}:{column}: {message}")
                    self.assertEqual(os.listdir(self.folder), ["bad.toml"])

    def test_an_unknown_control_is_told_the_known_ones(self):
        self.write("bad.toml", edit(TINY, ('name = "downwind"', 'name = "upwind"')))
        done = self.acstudy("run", "bad.toml", "--out", "out")
        self.assertEqual(done.returncode, 2)
        self.assertIn('name = "upwind"; it must be one of "SPH sum", ', done.stderr)


if __name__ == "__main__":
    unittest.main()
