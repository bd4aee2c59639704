"""Mistakes in a scheme that is a program."""

import unittest

from tests.bad_studies import (EXTREMES, KERNEL, PATH_TABLE, SCHEME_TABLE, STEPS, SWEEP, TIME_TABLE, VERDICTS, Mistakes,
                               bad)
from tests.program import STUDY, edit

PROGRAM = '[[scheme]]\ncommand = ["true"]\norder = 1\n'
REFUSED = ("a study of this kind looks into the sums of its schemes, which a command keeps to itself; name it in a study of "
           'kind "convergence", and write model = 1 here')
WRITTEN = 'every entry must be a text that is not empty: write command = ["python3", "solver.py"]'
TIME = 'it is a time of at most 1e+07 s with its unit, s, min or h: write timeout = "60 s"'


def program(*changes):
    return bad((SCHEME_TABLE, edit(PROGRAM, *changes)))


def timeout(value):
    return program(("order = 1", f"order = 1\ntimeout = @{value}"))


def of_kind(study):
    return edit(study, (SCHEME_TABLE, PROGRAM.replace("[\"true\"]", "@[\"true\"]")))


MISTAKES = {
    "no order": (program(("[[scheme]]", "@[[scheme]]"), ("order = 1\n", "")),
                 '[[scheme]] has no "order"; write, for example, order = 1'),
    "a negative order": (program(("order = 1", "order = @-1")), "order = -1; an order must be finite and not negative"),
    "a command that is a text": (program(('["true"]', '@"true"')),
                                 'command must be a list, not "true"; write, for example, command = ["python3", '
                                 '"solver.py"]'),
    "an empty command": (program(('["true"]', "@[]")), 'command must be a list, not an empty list; write, for example, '
                         'command = ["python3", "solver.py"]'),
    "a number in a command": (program(('["true"]', '["true", @1]')), f"command contains 1; {WRITTEN}"),
    "an empty word in a command": (program(('["true"]', '["true", @""]')), f'command contains ""; {WRITTEN}'),
    "a model and a command": (program(('["true"]', '@["true"]'), ("order = 1", "order = 1\nmodel = 1")),
                              "command stands beside model, which is of a scheme of acstudy; leave out one or the other"),
    "a label without a command": (bad((KERNEL, KERNEL + '\nlabel = @"mine"')), "label goes with command; leave it out"),
    "an order without a command": (bad((KERNEL, KERNEL + "\norder = @2")), "order goes with command; leave it out"),
    "an empty label": (program(("order = 1", 'order = 1\nlabel = @""')),
                       'a label is one line of text, for example "upwind"'),
    "a label a second time": (bad((SCHEME_TABLE, PROGRAM + "\n@" + PROGRAM)),
                              'a second scheme with the label "true"; labels must differ: write label = "..."'),
    "an unknown verdict": (program(("order = 1", 'order = 1\nexpect = @"wrong"')),
                           f'expect = "wrong"; it must be one of {VERDICTS}'),
    "no file": (program(("order = 1", 'order = 1\ninputs = [@"table.txt"]')),
                'inputs contains "table.txt", but there is no such file that can be read; names are relative to the study '
                "file"),
    "a folder for a file": (program(("order = 1", 'order = 1\ninputs = [@"."]')),
                            'inputs contains ".", but there is no such file that can be read; names are relative to the '
                            "study file"),
    "a time without a unit": (timeout('"60"'), f'timeout = "60"; {TIME}'),
    "a time with another unit": (timeout('"60 m"'), f'timeout = "60 m"; {TIME}'),
    "no time": (timeout("0"), f"timeout = 0; {TIME}"),
    "a negative time": (timeout('"-1 s"'), f'timeout = "-1 s"; {TIME}'),
    "an endless time": (timeout('"1e9 h"'), f'timeout = "1e9 h"; {TIME}'),
    "a model beside it needs its time": (
        "@" + bad((TIME_TABLE, ""), (SCHEME_TABLE, PROGRAM + "\n" + SCHEME_TABLE)), "the study has no [time]; add it"),
    "a model beside it needs its horizon": (
        bad((SCHEME_TABLE, PROGRAM + "\n" + SCHEME_TABLE), ("[[path]]", "@[[path]]"), ('delta = "4*h"\n', "")),
        '[[path]] has no "delta"; write, for example, delta = "4*h"'),
    "stability": (of_kind(SWEEP), REFUSED),
    "a stability map": (of_kind(STEPS), REFUSED),
    "extremes": (of_kind(EXTREMES), REFUSED),
    "a map": (edit(of_kind(STUDY), ("[study]", '[study]\nkind = "map"'), (PATH_TABLE, "[map]\ndelta = [0.1, 0.2, 0.3, 0.4]\n"
                                    'N = [16, 32, 64, 128]\nsources = ["local"]\n')), REFUSED),
    "controls": (edit(of_kind(STUDY), ("[study]", '[study]\nkind = "controls"')) + '[[consistency]]\nname = "a"\n'
                 'delta = "4*h"\nN = [16, 32]\nsource = "local"\n', REFUSED),
}


class BadPrograms(Mistakes):
    def test_every_mistake_has_its_message_and_place(self):
        self.assert_refused(MISTAKES)

    def test_an_error_budget_has_no_program(self):
        self.write("tiny.toml", program())
        self.write("budget.toml", '[study]\nname = "budget"\nkind = "pollution"\n\n[pollution]\nstudies = ["tiny.toml"]\n')
        self.assert_bad_input(self.acstudy("run", "budget.toml", "--out", "out"),
                              'budget.toml:6:12: studies contains "tiny.toml", which has a command for a scheme; its steps '
                              "and source cannot be taken apart")


if __name__ == "__main__":
    unittest.main()
