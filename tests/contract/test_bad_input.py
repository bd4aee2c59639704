"""Bad input: the complete message, exit code 2, and nothing run or written."""

import os
import tempfile
import unittest

from tests.program import FIELDS, INLINE, MODEL_II, STUDY, UNSOLVED, USE, ProgramTest, edit

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


# What is wrong: (the study, the message). The message points at the character behind the @, which the study that the
# program reads does not have.
STUDIES = {
    # Keys and tables
    "unknown table": (bad(("[time]", "[@grid]\nn = 1\n\n[time]")),
                      'unknown key "grid" in the study; known keys: study, scene, scheme, time, path, source'),
    "unknown key above the tables": (
        "@n = 1\n" + STUDY, 'unknown key "n" in the study; known keys: study, scene, scheme, time, path, source'),
    "unknown key in [study]": (bad(("title =", "@author =")),
                               'unknown key "author" in [study]; known keys: name, title, kind'),
    "unknown key in [scene]": (inline(('T = 1', '@time = 1')),
                               'unknown key "time" in [scene]; known keys: use, period, T, c, b, u, flow, '
                               'reference, u0, f'),
    "field beside a named scene": (bad((USE, USE + '\n@c = "1"')), 'unknown key "c" in [scene]; known keys: use, T'),
    "unknown key in [[scheme]]": (bad((KERNEL, KERNEL + "\n@alpha = 1")),
                                  'unknown key "alpha" in [[scheme]]; known keys: model, divergence, kernel, mu'),
    "unknown key of a kernel": (kernel('{ name = "power", alpha = 0.5, @beta = 1 }'),
                                'unknown key "beta" in kernel; known keys: name, alpha'),
    "unknown key in [time]": (bad(("step =", "@dt =")), 'unknown key "dt" in [time]; known keys: integrator, step, '
                              'safety, bound, expect'),
    "unknown key in [[path]]": (bad((SOURCE, '@target = "local"')),
                                'unknown key "target" in [[path]]; known keys: name, delta, N, source, reference, '
                                'expect, order, start'),
    "unknown key in [source]": (STUDY + '[source]\n@method = "gauss"\n',
                                'unknown key "method" in [source]; known keys: rule'),
    "no [study]": ("@" + STUDY[STUDY.index("[scene]"):], "the study has no [study]; add it"),
    "no [scene]": ("@" + bad(("[scene]\n" + USE + "\n", "")), "the study has no [scene]; add it"),
    "no [[scheme]]": ("@" + bad((SCHEME_TABLE, "")), "the study has no [[scheme]]; add at least one"),
    "no [time]": ("@" + bad((TIME_TABLE, "")), "the study has no [time]; add it"),
    "no [[path]]": ("@" + bad((PATH_TABLE, "")), "the study has no [[path]]; add at least one"),
    "[scheme] for [[scheme]]": (bad(("[[scheme]]", "@[scheme]")),
                                "scheme must be a list of tables; write [[scheme]] above its keys"),
    "[[study]] for [study]": (bad(("[study]", "@[[study]]")), "study must be a table; write [study] above its keys"),
    "a number for [study]": ("study = @1\n" + STUDY[STUDY.index("[scene]"):],
                             "study must be a table; write [study] above its keys"),
    "no name": (bad(('[study]\nname = "tiny"', "@[study]")),
                '[study] has no "name"; write, for example, name = "fig2"'),
    "no period": (inline(('[scene]\nperiod = "2*pi"', "@[scene]")),
                  '[scene] has no "period"; write, for example, period = "2*pi"'),
    "no final time": (inline(("[scene]", "@[scene]"), ("T = 1\n", "")),
                      '[scene] has no "T"; write, for example, T = 1'),
    "no velocity": (inline(("[scene]", "@[scene]"), ('c = "cos(2*x)/3"\n', "")),
                    '[scene] has no "c"; write, for example, c = "cos(2*x)/3"'),
    "no solution": (inline(("[scene]", "@[scene]"), ('u = "cos(x-t)"\n', "")),
                    '[scene] has no "u"; write, for example, u = "cos(x-t)", or reference = "finest" and u0 = "cos(x)" '
                    "where no solution is known"),
    "a solution and a reference": (unsolved(('reference = "', 'u = "cos(x-t)"\nreference = @"')),
                                   "u gives the exact solution, and reference is for scenes without one; leave out one "
                                   "or the other"),
    "initial values beside a solution": (inline(('u = "cos(x-t)"', 'u = "cos(x-t)"\nu0 = @"cos(x)"')), given("u0")),
    "a source beside a solution": (inline(('u = "cos(x-t)"', 'u = "cos(x-t)"\nf = @0')), given("f")),
    "a reference that is none": (unsolved(('"finest"', '@"finer"')), 'reference = "finer"; it must be one of "finest"'),
    "no initial values": (unsolved(("[scene]", "@[scene]"), ('u0 = "cos(x)"\n', "")),
                          '[scene] has no "u0"; write, for example, u0 = "cos(x)", the values at t = 0'),
    "initial values in t": (unsolved(('"cos(x)"', '"cos(x-@t)"')), 'unknown name "t"; it may use x, pi, e and the usual functions'),
    "initial values not periodic": (unsolved(('"cos(x)"', '"@cos(x/2)"')),
                                     "u0 is not periodic: u0(x + 6.28319) and u0(x) differ by 2"),
    "a source not periodic": (unsolved(('"sin(x-t)"', '"@sin(x/2)"')), "f is not periodic: f(x + 6.28319) and f(x) differ by 2"),
    "a nonlocal source without a solution": (
        unsolved((SOURCE, 'source = @"nonlocal"')),
        'source = "nonlocal" makes a known u solve the nonlocal model; here the source is the scene\'s f, so write '
        '"local" or leave it out'),
    "a path's reference where the solution is known": (
        bad((SOURCE, SOURCE + "\nreference = @1280")),
        'a reference goes with reference = "finest" under [scene]; u is known, so leave it out'),
    "a reference that is no finer": (unsolved((SOURCE, "reference = @64")),
                                     "reference = 64; it must be a whole number from 65 to 100000000"),
    "nothing beside the reference": (unsolved((LEVELS, "@[16]")),
                                     "N = [16]; the finest level is the reference, so nothing is left to judge: write "
                                     "more levels"),
    "a kind that needs a solution": (unsolved(("[study]", '[study]\nkind = "map"'), ('"finest"', '@"finest"'),
                                              (PATH_TABLE, "[map]\ndelta = [0.1, 0.2, 0.3, 0.4]\nN = [16, 32, 64, 128]\n"
                                               'sources = ["local"]\n')), NEEDED),
    "operators without a solution": (edit(SWEEP, (USE, FIELDS), ('u = "cos(x-t)"', 'reference = @"finest"')), NEEDED),
    "digits without a solution": (edit(DIGITS, (USE, FIELDS), ('u = "cos(x-t)"', 'reference = @"finest"')), NEEDED),
    "no fields": (bad(("[scene]\n" + USE, "@[scene]")),
                  '[scene] names no scene and gives no fields; write use = "lee-du-2019", or period, T, c and u'),
    "no model": (bad(("[[scheme]]\nmodel = 1", "@[[scheme]]")),
                 '[[scheme]] has no "model"; write, for example, model = 1'),
    "no divergence where particles move": (
        bad(("[[scheme]]", "@[[scheme]]"), ('divergence = "local"\n', "")),
        '[[scheme]] has no "divergence"; write, for example, divergence = "local"'),
    "no kernel": (bad(("[[scheme]]", "@[[scheme]]"), (KERNEL + "\n", "")),
                  '[[scheme]] has no "kernel"; write, for example, kernel = "cubic-spline"'),
    "no integrator": (bad(('[time]\nintegrator = "forward-euler"', "@[time]")),
                      '[time] has no "integrator"; write, for example, integrator = "forward-euler"'),
    "no step": (bad(("[time]", "@[time]"), ('step = "h/4"\n', "")),
                '[time] has no "step"; write, for example, step = "h/4"'),
    "no path name": (bad(('[[path]]\nname = "delta = 4h"', "@[[path]]")),
                     '[[path]] has no "name"; write, for example, name = "delta = 4h"'),
    "no delta": (bad(("[[path]]", "@[[path]]"), ('delta = "4*h"\n', "")),
                 '[[path]] has no "delta"; write, for example, delta = "4*h"'),
    "no levels": (bad(("[[path]]", "@[[path]]"), ("N = [16, 32, 64]\n", "")),
                  '[[path]] has no "N"; write, for example, N = [160, 320, 640, 1280]'),
    "no source": (bad(("[[path]]", "@[[path]]"), (SOURCE + "\n", "")),
                  '[[path]] has no "source"; write, for example, source = "local"'),

    # Types and words
    "name is a number": (bad(('"tiny"', "@7")), 'name must be a string, not 7; write, for example, name = "fig2"'),
    "name with a capital": (bad(('"tiny"', '@"Tiny"')),
                            'name = "Tiny"; it names result files and may use a-z, 0-9 and - only'),
    "name that leaves the folder": (bad(('"tiny"', '@"../tiny"')),
                                    'name = "../tiny"; it names result files and may use a-z, 0-9 and - only'),
    "empty name": (bad(('"tiny"', '@""')), 'name = ""; it names result files and may use a-z, 0-9 and - only'),
    "title is a list": (bad(('"A tiny study"', "@[1]")),
                        'title must be a string, not an array; write, for example, title = "..."'),
    "unknown scene": (bad((USE, 'use = @"lee-du"')),
                      'unknown scene "lee-du"; known scenes: lee-du-2019, standing-variable-velocity, '
                      "constant-velocity, lagrangian"),
    "model 3": (bad(("model = 1", "model = @3")), "model = 3; it must be 1 or 2"),
    "model is a string": (bad(("model = 1", 'model = @"1"')), 'model = "1"; it must be 1 or 2'),
    "model is a real number": (bad(("model = 1", "model = @1.0")), "model = 1.0; it must be 1 or 2"),
    "unknown divergence": (bad(('divergence = "local"', 'divergence = @"exact"')),
                           'divergence = "exact"; it must be one of "local", "nonlocal"'),
    "divergence is true": (bad(('divergence = "local"', "divergence = @true")),
                           'divergence = true; it must be one of "local", "nonlocal"'),
    "unknown integrator": (bad(('"forward-euler"', '@"rk4"')),
                           'integrator = "rk4"; it must be one of "forward-euler", "ssprk2", "ssprk3", '
                           '"backward-euler", "sdirk2"'),
    "safety without a bound": (bad(('"h/4"', '"h/4"\nsafety = @0.9')),
                               'safety goes with step = "cfl"; leave it out'),
    "bound without a bound": (bad(('"h/4"', '"h/4"\nbound = @"rows"')), 'bound goes with step = "cfl"; leave it out'),
    "safety of zero": (bad(('"h/4"', '"cfl"\nsafety = @0')),
                       'safety = 0; the fraction of the bound must be positive and finite: write safety = 0.9'),
    "no bound to follow": (bad((USE, USE.replace("lee-du-2019", "lagrangian")), ('"h/4"', '@"cfl"')),
                           'step = "cfl" where c - b is zero, so that no bound limits a step; write an expression in h '
                           'and N such as "h/4"'),
    "unknown bound": (bad(('"h/4"', '"cfl"\nbound = @"mine"')),
                      'bound = "mine"; it must be one of "lemma", "rows"'),
    "the same steps a second time": (bad(("[time]", "[[time]]")) + '\n@[[time]]\nintegrator = "forward-euler"\n'
                                     'step = "h/4"\n',
                                     "the same integrator and steps a second time; leave one of them out"),
    "unknown start": (bad((SOURCE, SOURCE + '\nstart = @"random"')),
                      'start = "random"; it must be one of "uniform", "jittered", "clustered"'),
    "start without its gap": (bad((SOURCE, SOURCE + '\nstart = @"jittered"')),
                              f"this start needs its smallest gap; write {JITTERED}"),
    "start without its gap in a table": (bad((SOURCE, SOURCE + '\nstart = @{ name = "clustered" }')),
                                         f'start has no "smallest_gap"; write, for example, {JITTERED}'),
    "start with coincident particles": (
        bad((SOURCE, SOURCE + '\nstart = { name = "jittered", smallest_gap = @0 }')),
        f"smallest_gap = 0; in units of h it lies between 0 and 1: write {JITTERED}"),
    "seed of a start without chance": (
        bad((SOURCE, SOURCE + '\nstart = { name = "clustered", smallest_gap = 0.1, @seed = 2 }')),
        'unknown key "seed" in start; known keys: name, smallest_gap'),
    "uniform start with a gap": (bad((SOURCE, SOURCE + '\nstart = { name = "uniform", @smallest_gap = 0.1 }')),
                                 'unknown key "smallest_gap" in start; known keys: name'),
    "unknown source": (bad((SOURCE, 'source = @"exact"')), 'source = "exact"; it must be one of "local", "nonlocal"'),
    "unknown source rule": (STUDY + '[source]\nrule = @"simpson"\n',
                            'rule = "simpson"; it must be one of "gauss", "gsl", "boost"'),
    "unknown verdict": (bad((SOURCE, SOURCE + '\nexpect = @"good"')), f'expect = "good"; it must be one of {VERDICTS}'),
    "order is a string": (bad((SOURCE, SOURCE + '\norder = @"2"')), 'order must be a number, not "2"'),
    "negative order": (bad((SOURCE, SOURCE + "\norder = @-1")),
                       "order = -1; an order must be finite and not negative"),
    "order is not a number": (bad((SOURCE, SOURCE + "\norder = @nan")),
                              "order = nan; it must be finite"),
    "path name is a number": (bad(('"delta = 4h"', "@4")),
                              'name must be a string, not 4; write, for example, name = "delta = 4h"'),
    "empty path name": (bad(('"delta = 4h"', '@""')), 'a path needs a name, for example "delta = 4h"'),

    # Schemes
    "unknown kernel": (kernel('@"gauss"'), 'unknown kernel "gauss"; known kernels: inverse, power, cubic-spline'),
    "unknown kernel in a table": (kernel('{ name = @"gauss" }'),
                                  'unknown kernel "gauss"; known kernels: inverse, power, cubic-spline'),
    "unknown kernel with an exponent": (kernel('{ name = @"gauss", alpha = 0.5 }'),
                                        'unknown kernel "gauss"; known kernels: inverse, power, cubic-spline'),
    "kernel is a number": (kernel("@3"), 'kernel must be a string, not 3; write, for example, kernel = "inverse"'),
    "kernel without name": (kernel("@{ alpha = 0.5 }"),
                            'kernel has no "name"; write, for example, { name = "power", alpha = 0.5 }'),
    "power without alpha": (kernel('@"power"'),
                            'the power kernel needs its exponent; write { name = "power", alpha = 0.5 }'),
    "power table without alpha": (kernel('@{ name = "power" }'),
                                  'the power kernel has no alpha; write { name = "power", alpha = 0.5 }'),
    "alpha 2": (kernel('{ name = "power", alpha = @2 }'),
                "alpha = 2; the power kernel has a first moment only for a finite alpha < 2"),
    "alpha nan": (kernel('{ name = "power", alpha = @nan }'),
                  "alpha = nan; it must be finite"),
    "alpha is a string": (kernel('{ name = "power", alpha = @"half" }'), 'alpha must be a number, not "half"'),
    "alpha of the inverse kernel": (kernel('{ name = "inverse", alpha = @1 }'),
                                    "the inverse kernel has no alpha; leave it out"),
    "inverse kernel in Model II": (
        kernel_ii('@"inverse"'), 'Model II needs an integrable kernel, and the inverse kernel is not; write '
        '"cubic-spline" or { name = "power", alpha = 0.5 } with alpha < 1'),
    "alpha 1 in Model II": (kernel_ii('{ name = "power", alpha = @1.0 }'),
                            "alpha = 1; Model II needs an integrable kernel: alpha < 1"),
    "mu in Model I": (bad((KERNEL, KERNEL + "\nmu = @1.5")), "Model I has no viscosity; leave mu out"),
    "negative mu": (kernel_ii('"cubic-spline"\nmu = @-1'),
                    "mu = -1; a viscosity bound must be finite and not negative"),
    "infinite mu": (kernel_ii('"cubic-spline"\nmu = @inf'),
                    "mu = inf; it must be finite"),
    "mu is a string": (kernel_ii('"cubic-spline"\nmu = @"4/3"'), 'mu must be a number, not "4/3"'),
    "the same scheme twice": (bad(("[time]", "@" + SCHEME_TABLE + "\n[time]")),
                              "the same scheme a second time; leave one of them out"),
    "the same scheme twice, once with the default mu": (
        bad(MODEL_II, ("[time]", "@" + edit(SCHEME_TABLE, MODEL_II) + "mu = 1.3333333333333333\n\n[time]")),
        "the same scheme a second time; leave one of them out"),

    # Levels
    "N is a number": (bad((LEVELS, "@64")), "N must be a list of particle numbers, not 64; write "
                      "N = [160, 320, 640, 1280]"),
    "no level": (bad((LEVELS, "@[]")), "N must be a list of particle numbers, not an empty list; write "
                 "N = [160, 320, 640, 1280]"),
    "N = 2": (bad((LEVELS, "[@2, 32, 64]")), "N = 2; a periodic interval needs at least 3 particles"),
    "unsorted levels": (bad((LEVELS, "[16, 64, @32]")), "N = 32 after 64; levels must go from coarse to fine"),
    "a level twice": (bad((LEVELS, "[16, 32, @32]")), "N = 32 after 32; levels must go from coarse to fine"),
    "half a particle": (bad((LEVELS, "[16, @32.5, 64]")), "N contains 32.5; every entry must be a whole number"),
    "a real number of particles": (bad((LEVELS, "[16, @32.0, 64]")),
                                   "N contains 32.0; every entry must be a whole number"),
    "a quoted level": (bad((LEVELS, '[16, @"32", 64]')), 'N contains "32"; every entry must be a whole number'),
    "too many particles": (bad((LEVELS, "[16, 32, @100000001]")), "N = 100000001; the most is 100000000"),
    "two paths of one name": (STUDY + edit(PATH_TABLE, ('"delta = 4h"', '@"delta = 4h"')),
                              'a second path named "delta = 4h"; names must differ'),

    # Expressions
    "unknown name": (bad_delta('"4*@k"'), f'delta = "4*k": unknown name "k"; {NAMES}'),
    "x in delta": (bad_delta('"4*h + @x"'), f'delta = "4*h + x": unknown name "x"; {NAMES}'),
    "delta in step": (bad((STEP, '"h/4*@delta"')), f'step = "h/4*delta": unknown name "delta"; {NAMES}'),
    "unknown function": (bad_delta('"4*@sinc(h)"'), f'delta = "4*sinc(h)": unknown name "sinc"; {NAMES}'),
    "function without parentheses": (bad_delta('"4*@sin h"'),
                                     'delta = "4*sin h": the function "sin" needs its argument in parentheses'),
    "missing parenthesis": (bad_delta('"4*(@h"'), 'delta = "4*(h": a closing parenthesis is missing'),
    "parenthesis too many": (bad_delta('"4*h@)"'), 'delta = "4*h)": unexpected parenthesis ")"'),
    "empty expression": (bad_delta('"@"'), 'delta = "": the expression is empty'),
    "blank expression": (bad_delta('"@  "'), 'delta = "  ": the expression is empty'),
    "unfinished expression": (bad_delta('"4@*"'), 'delta = "4*": the expression ends too early'),
    "missing operator": (bad_delta('"4@h"'), 'delta = "4h": unexpected value "h"; an operator is missing before it'),
    "power as in Python": (bad_delta('"h@**2"'), 'delta = "h**2": unexpected "**"; write h^2 for a power'),
    "condition": (bad_delta('"h @< 1 ? h : 1"'),
                  'delta = "h < 1 ? h : 1": unexpected "<"; an expression has no conditions'),
    "too few arguments": (bad_delta('"min(h@)"'), 'delta = "min(h)": too few arguments for "min"'),
    "too many arguments": (bad_delta('"sqrt(h,1@)"'), 'delta = "sqrt(h,1)": too many arguments for "sqrt"'),
    "two expressions": (bad_delta('"h@, 2"'), 'delta = "h, 2": unexpected comma'),
    "delta is a list": (bad_delta("@[1]"),
                        'delta must be an expression or a number, not an array; write, for example, delta = "4*h"'),
    "step is a table": (bad((STEP, "@{ a = 1 }")),
                        'step must be an expression or a number, not a table; write, for example, step = "h/4"'),
    "unknown name in a field": (inline(("cos(2*x)", "cos(2*@y)")),
                                'unknown name "y"; it may use x, pi, e and the usual functions'),
    "t in the velocity": (inline(("cos(2*x)/3", "cos(2*x)/3 + @t")),
                          'unknown name "t"; it may use x, pi, e and the usual functions'),
    "x in the period": (inline(('"2*pi"', '"2*@x"')), 'unknown name "x"; it may use pi, e and the usual functions'),

    # Horizons and steps
    "negative horizon": (bad_delta('@"h - 1"'), f"delta = -0.607301 {COARSE}; {POSITIVE_DELTA}"),
    "negative number as horizon": (bad_delta("@-0.1"), f"delta = -0.1 {COARSE}; {POSITIVE_DELTA}"),
    "zero horizon": (bad_delta('@"0"'), f"delta = 0 {COARSE}; {POSITIVE_DELTA}"),
    "infinite horizon": (bad_delta('@"1/0"'), f"delta = inf {COARSE}; {POSITIVE_DELTA}"),
    "horizon that is not a number": (bad_delta('@"sqrt(-1)"'), f"delta = nan {COARSE}; {POSITIVE_DELTA}"),
    "horizon is TOML's nan": (bad_delta("@nan"), "delta = nan; it must be finite"),
    "horizon is TOML's -inf": (bad_delta("@-inf"), "delta = -inf; it must be finite"),
    "horizon vanishes at one level": (
        bad_delta('@"h - pi/32"'),
        "delta = 0 at h = 0.0981748 (N = 64); " + POSITIVE_DELTA),
    "horizon too large at one level": (
        bad_delta('@"8*h"'), f"delta = 3.14159 {COARSE}; a horizon must stay below half the period, 3.14159, or a "
        "particle would meet its own images"),
    "zero step": (bad((STEP, "@0")), f"step = 0 {COARSE}; {POSITIVE_STEP}"),
    "negative step": (bad((STEP, '@"-h/4"')), f"step = -0.0981748 {COARSE}; {POSITIVE_STEP}"),
    "step that is not a number": (bad((STEP, '@"log(-h)"')), f"step = nan {COARSE}; {POSITIVE_STEP}"),
    "endless run": (bad((STEP, '@"1e-13"')), f"step = 1e-13 {COARSE} asks for 1e+13 steps; the most is 1e12"),

    # Sweeps of other kinds of study
    "negative ratio": (bad(("ratios = [1]", "ratios = [@-1]"), of=SWEEP),
                       "ratios contains -1; every entry must be positive and finite: write "
                       "ratios = [0.01, 0.5, 1, 4, 30]"),
    "horizon of a sweep too large": (
        bad(("ratios = [1]", "ratios = [1]\nhorizons = @[4]"), of=SWEEP),
        "delta = 4 at h = 0.15708 (N = 40); a horizon must stay below half the period, 3.14159, or a particle would "
        "meet its own images"),
    "kernel of no scheme": (
        bad(("ratios = [1]", 'ratios = [1]\n\n[printed]\nviolated = [@"inverse"]'), of=SWEEP),
        'no [[scheme]] of Model II has the kernel "inverse"; name one of those as explain prints it'),
    "no relative velocity to study": (
        bad(('[scene]\nuse = "lee-du-2019"', '@[scene]\nperiod = "2*pi"\nT = 1\nc = "sin(x)"\nb = "sin(x)"\nu = "cos(x)"'),
            of=SWEEP), "c - b is zero everywhere, so there is no operator to study; choose another c or b"),
    "path in a study without paths": (bad(("[sweep]", "[[@path]]\nname = 1\n\n[sweep]"), of=SWEEP),
                                      'unknown key "path" in the study; known keys: study, scene, scheme, sweep, '
                                      'printed'),

    # Stability maps
    "map of no integrator": (bad(("[stability-map]", "@[stability-map]"), ('integrators = ["forward-euler"]\n', ""),
                                 of=STEPS),
                             '[stability-map] has no "integrators"; write, for example, integrators = ["forward-euler", '
                             '"backward-euler"]'),
    "map of an integrator again": (bad(('["forward-euler"]', '["forward-euler", @"forward-euler"]'), of=STEPS),
                                   '"forward-euler" a second time; leave it out'),
    "map of a CFL number of zero": (bad(("cfl = [1]", "cfl = [@0]"), of=STEPS),
                                    "cfl contains 0; every entry must be positive and finite: write cfl = [0.5, 1, 2, 4]"),
    "map over no time": (bad(('[scene]\nuse = "lee-du-2019"', '@[scene]\nuse = "lee-du-2019"\nT = 0'), of=STEPS),
                         "T = 0; growth over T needs time: write T = 1"),
    "map of a control that is stable": (
        STEPS + '[[control]]\nname = @"source off by 1 %"\nscheme = { model = 1, divergence = "local", kernel = "inverse" }\n',
        'name = "source off by 1 %"; only controls that no step of forward Euler keeps stable belong here: SPH sum, no '
        'viscosity, downwind'),
    "gap below the spacing of numbers": (
        bad((SOURCE, SOURCE + '\nstart = @{ name = "jittered", smallest_gap = 1e-20 }')),
        "smallest_gap = 1e-20 is a gap of 3.93e-21 at N = 16, which positions near 6.28 cannot hold; write a larger one"),

    # Digits
    "scheme in a study of weights": (bad(("[digits]", '[[@scheme]]\nmodel = 1\n\n[digits]'), of=DIGITS),
                                     'unknown key "scheme" in the study; known keys: study, weights, digits, scene, '
                                     'gaps'),
    "divergence of weights": (bad(("model = 1", 'model = 1\n@divergence = "local"'), of=DIGITS),
                              'unknown key "divergence" in [[weights]]; known keys: model, kernel'),
    "weights of Model II with a singular kernel": (
        bad(("model = 1", "model = 2"), ('kernel = "inverse"', 'kernel = @"inverse"'), of=DIGITS),
        'Model II needs an integrable kernel, and the inverse kernel is not; write "cubic-spline" or { name = "power", '
        'alpha = 0.5 } with alpha < 1'),
    "same weights again": (bad(("[digits]", '@[[weights]]\nmodel = 1\nkernel = "inverse"\n\n[digits]'), of=DIGITS),
                           "the same weights a second time; leave one of them out"),
    "ratio beyond the memory": (bad(("ratios = [1]", "ratios = [@1e6]"), of=DIGITS),
                                "ratios contains 1000000; every entry must be positive and at most 100000: write "
                                "ratios = [1e-12, 0.5, 2.5, 100, 1e4]"),
    "no time at all": (bad(("times = [1]", "times = [@0]"), of=DIGITS),
                       "times contains 0; every entry must be positive and at most 30: write times = [1, 5, 8]"),
    "scene without gaps": (bad(("[scene]", "@[scene]"), ("[gaps]\nN = 10\ntimes = [1]\n", ""), of=DIGITS),
                           "only [gaps] needs a scene; leave one out or add the other"),
    "gaps of another flow": (
        bad(('[scene]\nuse = "lee-du-2019"', '@[scene]\nperiod = "2*pi"\nT = 1\nc = 1\nb = "cos(x)"\nu = "cos(x)"'),
            of=DIGITS),
        'the exact gaps are those of b = sin(x) on the period 2*pi; use the scene "lee-du-2019"'),

    # Extremes
    "scene in a study of extremes": (bad(("[study]", '[@scene]\nuse = "lee-du-2019"\n\n[study]'), of=EXTREMES),
                                     'unknown key "scene" in the study; known keys: study, scheme, extremes'),
    "viscosity bound in a study of extremes": (
        bad(('model = 1\ndivergence = "local"\nkernel = "inverse"',
             'model = 2\ndivergence = "local"\nkernel = "cubic-spline"\nmu = @2'), of=EXTREMES),
        "every row of the table of extremes has its own viscosity bound, max |c - b|; leave mu out"),
    "no divergence in a study of extremes": (
        bad(('divergence = "local"\n', ""), ("[[scheme]]", "@[[scheme]]"),
                                                 of=EXTREMES),
        '[[scheme]] has no "divergence"; write, for example, divergence = "local"'),
    "too few particles for a study of extremes": (EXTREMES + "\n[extremes]\nN = @3\n",
                                                  "N = 3; it must be a whole number from 100 to 10000000"),
    "unknown extreme": (EXTREMES + "\n[extremes]\n@alpha = 2\n",
                        'unknown key "alpha" in [extremes]; known keys: N, steps'),

    # Scenes
    "zero period": (inline(('"2*pi"', "@0")), "period = 0; it must be positive and finite"),
    "negative period": (inline(('"2*pi"', '"@-2*pi"')), "period = -6.28319; it must be positive and finite"),
    "negative final time": (bad((USE, USE + "\nT = @-1")), "T = -1; it must be zero or positive and finite"),
    "infinite final time": (bad((USE, USE + "\nT = @inf")), "T = inf; it must be finite"),
    "velocity not periodic": (inline(("cos(2*x)/3", "@x")),
                              "c is not periodic: c(x + 6.28319) and c(x) differ by 6.28"),
    "particle velocity not periodic": (inline(('"sin(x)"', '"@sin(x/2)"')),
                                       "b is not periodic: b(x + 6.28319) and b(x) differ by 2"),
    "solution not periodic": (inline(("cos(x-t)", "@cos(x/2-t)")),
                              "u is not periodic: u(x + 6.28319) and u(x) differ by 2"),
    "solution periodic at the start only": (inline(("cos(x-t)", "@cos(x*(1+t))")),
                                            "u is not periodic: u(x + 6.28319) and u(x) differ by 1.84"),
    "infinite velocity": (inline(("cos(2*x)/3", "@1/sin(x)")), "c is inf at x = 0; it must be finite everywhere"),
    "flow without b": (inline(('b = "sin(x)"\n', ""), (FLOW, '"@' + FLOW[1:])),
                       "a flow without b; particles stand still unless b is given"),
    "flow beside b = 0": (inline(('b = "sin(x)"', "b = 0"), (FLOW, '"@' + FLOW[1:])),
                          "a flow without b; particles stand still unless b is given"),
    "flow faster than b": (inline((FLOW, '"@2*atan2(sin(x/2)*exp(2*t), cos(x/2))"')),
                           "the flow does not follow b: its velocity differs from b by 1 at t = 0; leave it out to "
                           "have it integrated"),
    "flow that starts elsewhere": (inline((FLOW, '"@x + 1"'), ('"sin(x)"', "0.5")),
                                   "the flow at t = 0 takes x = 0 to 1; it must leave it there"),
}


class BadStudy(ProgramTest):
    def test_every_mistake_has_its_message_and_place(self):
        for what, (marked, message) in STUDIES.items():
            with self.subTest(what):
                before, text = marked.split("@")[0], marked.replace("@", "")
                self.assertEqual(marked.count("@"), 1)
                line, column = before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1
                with tempfile.TemporaryDirectory() as self.folder:
                    self.write("bad.toml", text)
                    self.assert_bad_input(self.acstudy("run", "bad.toml", "--out", "out"),
                                          f"bad.toml:{line}:{column}: {message}")
                    self.assertEqual(os.listdir(self.folder), ["bad.toml"])

    def test_explain_says_the_same(self):
        for change, place in ((("model = 1", "model = 3"), "9:9: model = 3; it must be 1 or 2"),
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
        for name in ("missing.toml", "folder", "empty.toml"):
            for files in ((name,), ("good.toml", name)):
                for arguments in (("run", *files, "--out", "out"), ("explain", *files)):
                    with self.subTest(arguments):
                        self.assert_bad_input(
                            self.acstudy(*arguments),
                            f"{name}: cannot read the study file; name an existing, non-empty file")
        self.assert_nothing_written()

    def test_one_bad_study_stops_all(self):
        self.write("good.toml", STUDY)
        self.write("bad.toml", edit(STUDY, ('"tiny"', '"other"'), ("model = 1", "model = 3")))
        self.assert_bad_input(self.acstudy("run", "good.toml", "bad.toml", "--out", "out"),
                              "bad.toml:9:9: model = 3; it must be 1 or 2")
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
                ("folder", None, f"cannot read the result file; {remedy}"),
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
        for arguments, named in (((), "subcommand"), (("frobnicate",), "frobnicate"),
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
