"""Mistakes in what a study asks for: schemes, levels, expressions, horizons and steps, scenes."""

import unittest

from tests.bad_studies import (COARSE, FLOW, KERNEL, LEVELS, NAMES, PATH_TABLE, POSITIVE_DELTA, POSITIVE_STEP,
                               SCHEME_TABLE, STEP, Mistakes, bad, bad_delta, inline, kernel, kernel_ii)
from tests.program import MODEL_II, STUDY, UNSOLVED, USE, edit

KERNELS = ("inverse, power, cubic-spline, quartic-spline, quintic-spline, wendland-c2, wendland-c4, wendland-c6, "
           "gaussian, constant, hat")
MISTAKES = {
    # Budgets
    "a limit without a unit": (bad((STEP, STEP + '\nlimit = @"30"')), 'limit = "30"; it is a time of at most 1e+07 s with '
                               'its unit, s, min or h: write limit = "60 s"'),
    "a limit that nothing keeps": (bad((STEP, STEP + "\nlimit = @0")), "limit = 0; it is a time of at most 1e+07 s with its "
                                   'unit, s, min or h: write limit = "60 s"'),
    "too few levels to add": (bad((LEVELS, '{ from = 40, until = "decided", most = @319 }')),
                              "most = 319, which 3 levels from 40 on do not pass; an order takes 4: write most = 320"),
    "levels from nowhere": (bad((LEVELS, '@{ until = "decided", most = 320 }')),
                            'N has no "from"; write, for example, from = 40'),
    "levels until something else": (bad((LEVELS, '{ from = 40, until = @"confirmed", most = 320 }')),
                                    'until = "confirmed"; it must be one of "decided"'),
    "levels to add without u": (edit(UNSOLVED, (LEVELS, '@{ from = 40, until = "decided", most = 320 }')),
                                "levels are added where u is known, as a reference has to be finer than all of them; write "
                                "N = [160, 320, 640, 1280]"),
    # Schemes
    "unknown kernel": (kernel('@"gauss"'), f'unknown kernel "gauss"; known kernels: {KERNELS}; did you mean "gaussian"?'),
    "unknown kernel in a table": (kernel('{ name = @"gauss" }'),
                                  f'unknown kernel "gauss"; known kernels: {KERNELS}; did you mean "gaussian"?'),
    "unknown kernel with an exponent": (kernel('{ name = @"gauss", alpha = 0.5 }'),
                                        f'unknown kernel "gauss"; known kernels: {KERNELS}; did you mean "gaussian"?'),
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
    "kernel with a density that is no expression": (
        kernel('{ profile = "(1-s)^3*(1+3*@r)" }'),
        'profile = "(1-s)^3*(1+3*r)": unknown name "r"; it may use s, pi, e and the usual functions'),
    "kernel with a density that increases": (
        kernel('{ profile = "@s*(1-s)" }'), 'profile = "s*(1-s)": it increases, so that eta = -rho\' is negative, '
        'at s = 0.2422; both models need a kernel that is nowhere negative'),
    "kernel with a negative eta": (kernel('{ eta = "@1-2*s" }'), 'eta = "1-2*s": it is negative at s = 0.9922; both models need a '
                                   'kernel that is nowhere negative: a density goes by the name profile'),
    "kernel with a corner": (kernel('{ eta = "@max(0.3-s,0)" }'),
                             'eta = "max(0.3-s,0)": it is not smooth near s = 0.3; name the points where it is not: '
                             'breaks = [0.3]'),
    "kernel with breaks in disorder": (kernel('{ eta = "1", breaks = [0.5, @0.25] }'),
                                       "breaks contains 0.25; they are points between 0 and 1 in increasing order"),
    "kernel that grows at 0": (kernel('{ eta = "@1/s" }'), 'eta = "1/s": it goes like s^-1 at s = 0, which no polynomial '
                               'does; write exponent = 1, and for eta the rest'),
    "kernel without a first moment": (kernel('{ eta = "1", exponent = @2 }'),
                                      "exponent = 2; a kernel has a first moment only for one below 2"),
    "kernel that Model II cannot have": (kernel_ii('{ eta = "1", exponent = @1.5 }'),
                                         "exponent = 1.5; Model II needs an integrable kernel: exponent < 1"),
    "kernel with a density and eta": (kernel('{ profile = "1-s", eta = @"1" }'),
                                      "eta does not go with profile; leave one of them out"),
    "kernel with a density and an exponent": (kernel('{ profile = "1-s", exponent = @0.5 }'),
                                              "exponent does not go with profile; leave one of them out"),
    "a limiter of Model I": (bad(("model = 1", 'model = 1\nlimiter = @"clip"')), "Model I has no limiter; leave limiter out"),
    "an unknown limiter": (bad(("model = 1", 'model = "slopes"\nlimiter = @"minmod"')),
                           'limiter = "minmod"; it must be "clip"'),
    "no limiter as text": (bad(("model = 1", 'model = "slopes"\nlimiter = @""')), 'limiter = ""; it must be "clip"'),
    "a limiter and implicit steps": (
        bad(("model = 1", 'model = "slopes"\nlimiter = "clip"'), ('"forward-euler"', '"sdirk2"'), ('"h/4"', '@"h/4"')),
        "slopes, limiter clip is not linear, so that it has no matrix for implicit steps; take an explicit integrator, or "
        "leave limiter out"),
    "a limiter and the bound of rows": (
        bad(("model = 1", 'model = "slopes"\nlimiter = "clip"'), ('"h/4"', '@"cfl"\nbound = "rows"')),
        'slopes, limiter clip is not linear, so that it has no matrix for bound = "rows"; leave bound out, or leave '
        "limiter out"),
    "mu of slopes": (bad(("model = 1", 'model = "slopes"\nmu = @1')), "slopes has no viscosity; leave mu out"),
    "a nonlocal source for slopes": (
        bad(("model = 1", 'model = "slopes"'), ('delta = "4*h"', 'delta = @"4*h"'), ('source = "local"', 'source = "nonlocal"')),
        "slopes go to a nonlocal model with slopes that are averages over the horizon, whose source acstudy does not "
        'integrate; write source = "local"'),
    "a singular kernel of symmetric": (
        bad(("model = 1", 'model = "symmetric"'), ('kernel = "inverse"', 'kernel = @"inverse"')),
        'symmetric needs an integrable kernel, and the inverse kernel is not; write "cubic-spline" or '
        '{ name = "power", alpha = 0.5 } with alpha < 1'),
    "adaptive steps of V u": (
        bad(("model = 1", 'model = "symmetric"'), ('divergence = "local"', 'divergence = "nonlocal"'),
            ('kernel = "inverse"', 'kernel = "cubic-spline"'), ('"forward-euler"', '"ssprk3"'),
            ('"h/4"', '@"adaptive"\ntolerance = 1e-4')),
        "with the nonlocal divergence the unknown of symmetric is V u, and a tolerance is one of u; write a step, or "
        'divergence = "local"'),
    "kernel with a name and a text": (kernel('{ eta = "1", name = @"hat" }'),
                                      "name does not go with eta; leave one of them out"),
    "kernel with breaks of nothing": (kernel('{ breaks = @[0.5] }'),
                                      'breaks goes with a kernel of your own; write eta = "exp(-s)"'),
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
    "expression without quotes": (bad_delta("@4*h"), '4*h stands without quotes; put it in quotes: "4*h"'),
    "expression without quotes before a comment": (bad_delta("@4*h  # four"),
                                                   '4*h stands without quotes; put it in quotes: "4*h"'),
    "ratio without quotes": (bad((STEP, "@h/4")), 'h/4 stands without quotes; put it in quotes: "h/4"'),
    "word without quotes": (kernel("@inverse"), 'inverse stands without quotes; put it in quotes: "inverse"'),
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


class BadValues(Mistakes):
    def test_every_mistake_has_its_message_and_place(self):
        self.assert_refused(MISTAKES)


if __name__ == "__main__":
    unittest.main()
