"""Mistakes in what studies of other kinds have of their own."""

import unittest

from tests.bad_studies import DIGITS, EXTREMES, PATH_TABLE, SOURCE, STEPS, SWEEP, Mistakes, bad

MISTAKES = {
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

    # Schemes beyond the paper
    "slopes where theory is measured": (
        bad(("model = 1", 'model = @"slopes"'), of=SWEEP),
        'a study of kind stability measures what theory says of Models I and II; examine "slopes" in one of kind '
        "convergence, consistency, stability-map, controls"),
    "weights of slopes": (bad(("model = 1", 'model = @"slopes"'), of=DIGITS),
                          "only the weights of Models I and II are examined, not those of slopes"),
    "map of what is not linear": (
        bad(("[[scheme]]\nmodel = 1", '@[[scheme]]\nmodel = "slopes"\nlimiter = "clip"'), of=STEPS),
        "slopes, limiter clip is not linear, so that its steps have no matrix to study; leave limiter out"),
    "map of V u": (
        bad(('[[scheme]]\nmodel = 1\ndivergence = "local"\nkernel = "inverse"',
             '@[[scheme]]\nmodel = "symmetric"\ndivergence = "nonlocal"\nkernel = "cubic-spline"'), of=STEPS),
        "with the nonlocal divergence the unknown of symmetric is V u, whose steps are not those of u; write divergence = "
        '"local"'),
    "consistency of symmetric": (
        bad(('"stability"', '"consistency"'), ('[[scheme]]\nmodel = 1', '@[[scheme]]\nmodel = "symmetric"'),
            ('"inverse"', '"cubic-spline"'), of=SWEEP) + PATH_TABLE,
        "what symmetric leaves of the equation on uneven particles is not of its order, which only its errors are; examine "
        "it in a study of kind convergence"),

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
                                     'gaps; did you mean "scene"?'),
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
                        'unknown key "alpha" in [extremes]; known keys: N, steps, levels'),
}


class BadKinds(Mistakes):
    def test_every_mistake_has_its_message_and_place(self):
        self.assert_refused(MISTAKES)


if __name__ == "__main__":
    unittest.main()
