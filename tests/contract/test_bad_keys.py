"""Mistakes in the keys, tables, types and words of a study."""

import unittest

from tests.bad_studies import (DIGITS, JITTERED, KERNEL, LEVELS, NEEDED, PATH_TABLE, SCHEME_TABLE, SOURCE, SWEEP,
                               TIME_TABLE, VERDICTS, Mistakes, bad, given, inline, kernel, unsolved)
from tests.program import FIELDS, STUDY, USE, edit

ADAPTIVE = (('"forward-euler"', '"ssprk3"'),)

MISTAKES = {
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
                                  'unknown key "alpha" in [[scheme]]; known keys: model, divergence, kernel, limiter, mu, '
                                  'command, label, order, expect, timeout, inputs'),
    "unknown key of a kernel": (kernel('{ name = "power", alpha = 0.5, @beta = 1 }'),
                                'unknown key "beta" in kernel; known keys: name, alpha, profile, eta, breaks, exponent; '
                                'did you mean "eta"?'),
    "unknown key in [time]": (bad(("step =", "@dt =")), 'unknown key "dt" in [time]; known keys: integrator, step, '
                              'safety, bound, tolerance, first, limit, expect'),
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

    # Several at once
    "two keys of one table": (bad(("[time]", "@[time]"), ('integrator = "forward-euler"\nstep = "h/4"\n', "")),
                              '2 keys are missing; write, for example, integrator = "forward-euler" and step = "h/4" in '
                              "[time]"),
    "keys of several tables": (
        bad(("[[scheme]]", "@[[scheme]]"), ('divergence = "local"\nkernel = "inverse"\n', ""), ('delta = "4*h"\n', ""),
            ('step = "h/4"\n', "")),
        '4 keys are missing; write, for example, divergence = "local" and kernel = "cubic-spline" in [[scheme]], '
        'step = "h/4" in [time] (line 11), delta = "4*h" in [[path]] (line 14)'),
    "keys of tables that are not there": (
        "@" + bad((TIME_TABLE, ""), (PATH_TABLE, "")),
        '6 keys are missing; write, for example, integrator = "forward-euler" and step = "h/4" in [time], name = "delta = '
        '4h" and delta = "4*h" and N = [160, 320, 640, 1280] and source = "local" in [[path]]'),
    "nothing but a name": ('@[study]\nname = "tiny"\n',
                           '10 keys are missing; write, for example, use = "lee-du-2019" in [scene], integrator = '
                           '"forward-euler" and step = "h/4" in [time], name = "delta = 4h" and delta = "4*h" and N = '
                           '[160, 320, 640, 1280] and source = "local" in [[path]], model = 1 and divergence = "local" '
                           'and kernel = "cubic-spline" in [[scheme]]'),
    "a key that is missing and another that is wrong": (
        bad(("[time]", "@[time]"), ('step = "h/4"\n', ""), ('"4*h"', '"4*k"')),
        '[time] has no "step"; write, for example, step = "h/4"'),

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
                      'constant-velocity, lagrangian; did you mean "lee-du-2019"?'),
    "model 3": (bad(("model = 1", "model = @3")), 'model = 3; it must be 1 or 2 or "slopes" or "symmetric"'),
    "model is a string": (bad(("model = 1", 'model = @"1"')), 'model = "1"; it must be 1 or 2 or "slopes" or "symmetric"'),
    "model is a real number": (bad(("model = 1", "model = @1.0")), 'model = 1.0; it must be 1 or 2 or "slopes" or "symmetric"'),
    "unknown divergence": (bad(('divergence = "local"', 'divergence = @"exact"')),
                           'divergence = "exact"; it must be one of "local", "nonlocal"'),
    "divergence is true": (bad(('divergence = "local"', "divergence = @true")),
                           'divergence = true; it must be one of "local", "nonlocal"'),
    "unknown integrator": (bad(('"forward-euler"', '@"rk4"')),
                           'integrator = "rk4"; it must be one of "forward-euler", "ssprk2", "ssprk3", '
                           '"backward-euler", "sdirk2", "sdirk3"'),
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
    "adaptive steps of an integrator without an estimate": (
        bad(('"h/4"', '@"adaptive"\ntolerance = 1e-4')),
        'step = "adaptive", but forward-euler has no estimate of its error; take one of the integrators "ssprk2", '
        '"ssprk3", "sdirk2", "sdirk3"'),
    "adaptive steps without a tolerance": (
        bad(("[time]", "@[time]"), ('"forward-euler"', '"ssprk3"'), ('"h/4"', '"adaptive"')),
        '[time] has no "tolerance"; write, for example, tolerance = 1e-4'),
    "a tolerance of equal steps": (bad(('"h/4"', '"h/4"\ntolerance = @1e-4')),
                                   'tolerance goes with step = "adaptive"; leave it out'),
    "a first step of steps within a bound": (bad(('"h/4"', '"cfl"\nfirst = @"h"')),
                                             'first goes with step = "adaptive"; leave it out'),
    "a bound of adaptive steps": (bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = 1e-4\nsafety = @0.9')),
                                  'safety goes with step = "cfl"; leave it out'),
    "tolerance of zero": (
        bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = @0')),
        'tolerance = 0 at h = 0.392699 (N = 16); a tolerance must be positive and finite: write an expression in h '
        'and N such as "1e-2*h^2"'),
    "tolerance below round-off": (
        bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = [1e-4, @1e-14]')),
        "tolerance = 1e-14 at h = 0.392699 (N = 16); round-off alone comes close to that: the least is 1e-13"),
    "tolerance of an unknown name": (
        bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = "1e-2*@k^2"')),
        'tolerance = "1e-2*k^2": unknown name "k"; it may use h, N, pi, e and the usual functions'),
    "empty list of tolerances": (
        bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = @[]')),
        "tolerance must be a list, not an empty list; write, for example, tolerance = [1e-2, 1e-3]"),
    "tolerance is a list of lists": (
        bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = [@[1e-4]]')),
        "tolerance must be an expression or a number, not an array; write, for example, tolerance = 1e-4"),
    "the same tolerance a second time": (
        bad(*ADAPTIVE, ("[time]", "@[time]"), ('"h/4"', '"adaptive"\ntolerance = [1e-4, 0.0001]')),
        "the same integrator and steps a second time; leave one of them out"),
    "first step of zero": (
        bad(*ADAPTIVE, ('"h/4"', '"adaptive"\ntolerance = 1e-4\nfirst = @"0*h"')),
        'first = 0 at h = 0.392699 (N = 16); a time step must be positive and finite: write an expression in h and N '
        'such as "h"'),
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
}


class BadKeys(Mistakes):
    def test_every_mistake_has_its_message_and_place(self):
        self.assert_refused(MISTAKES)


if __name__ == "__main__":
    unittest.main()
