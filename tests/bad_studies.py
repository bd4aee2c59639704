"""Studies with a mistake in them, and what the program says of it."""

import os
import tempfile

from tests.program import INLINE, MODEL_II, STUDY, UNSOLVED, ProgramTest, edit

KERNEL = 'kernel = "inverse"'
DELTA = '"4*h"'
LEVELS = "[16, 32, 64]"
SOURCE = 'source = "local"'
STEP = '"h/4"'
FLOW = '"2*atan2(sin(x/2)*exp(t), cos(x/2))"'
SCHEME_TABLE = '[[scheme]]\nmodel = 1\ndivergence = "local"\nkernel = "inverse"\n'
TIME_TABLE = '[time]\nintegrator = "forward-euler"\nstep = "h/4"\n'
SWEEP = ('[study]\nname = "sweep"\nkind = "stability"\n\n[scene]\nuse = "lee-du-2019"\n\n' + SCHEME_TABLE +
         '\n[sweep]\nN = [40]\nratios = [1]\n')
STEPS = ('[study]\nname = "steps"\nkind = "stability-map"\n\n[scene]\nuse = "lee-du-2019"\n\n' + SCHEME_TABLE +
         '\n[stability-map]\nN = 16\nratios = [1]\ncfl = [1]\nintegrators = ["forward-euler"]\n')
DIGITS = ('[study]\nname = "digits"\nkind = "digits"\n\n[[weights]]\nmodel = 1\nkernel = "inverse"\n\n[digits]\n'
          'ratios = [1]\n\n[scene]\nuse = "lee-du-2019"\n\n[gaps]\nN = 10\ntimes = [1]\n')
EXTREMES = '[study]\nname = "ends"\nkind = "extremes"\n\n' + SCHEME_TABLE
PATH_TABLE = STUDY[STUDY.index("[[path]]"):]

NAMES = "it may use h, N, pi, e and the usual functions"
VERDICTS = ('"confirmed", "pre-asymptotic", "below", "above", "stagnates", "floor", "diverges", "unstable", '
            '"inconclusive", "stable"')
JITTERED = '{ name = "jittered", smallest_gap = 0.01, seed = 1 }'
POSITIVE_DELTA = ('a horizon must be positive and finite: write an expression in h and N such as "4*h"')
POSITIVE_STEP = ('a time step must be positive and finite: write an expression in h and N such as "h/4"')
COARSE = "at h = 0.392699 (N = 16)"


def bad(*changes, of=STUDY):
    return edit(of, *changes)


def bad_delta(value):
    return bad((DELTA, value))


def kernel(value):
    return bad((KERNEL, f"kernel = {value}"))


def kernel_ii(value):
    return bad(MODEL_II, ('kernel = "cubic-spline"', f"kernel = {value}"))


def inline(*changes):
    return bad(*changes, of=INLINE)


def unsolved(*changes):
    return bad(*changes, of=UNSOLVED)


def given(key):
    return (f'{key} goes with reference = "finest", where no solution is known; u fixes it, so leave out one or the '
            "other")


NEEDED = ('a study of this kind needs the exact solution; write u = "cos(x-t)" in place of reference, u0 and f')


class Mistakes(ProgramTest):
    def assert_refused(self, studies):
        """Of each mistake the message and its place, exit code 2, and nothing written.

        `studies`: {what is wrong: (the study, the message)}. The message points at the character behind the @, which
        the study that the program reads does not have.
        """
        for what, (marked, message) in studies.items():
            with self.subTest(what):
                before, text = marked.split("@")[0], marked.replace("@", "")
                self.assertEqual(marked.count("@"), 1)
                line, column = before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1
                with tempfile.TemporaryDirectory() as self.folder:
                    self.write("bad.toml", text)
                    self.assert_bad_input(self.acstudy("run", "bad.toml", "--out", "out"),
                                          f"bad.toml:{line}:{column}: {message}")
                    self.assertEqual(os.listdir(self.folder), ["bad.toml"])
