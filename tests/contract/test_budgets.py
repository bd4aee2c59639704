"""What studies take and may take: predicted seconds and memory, limits, levels until the verdict is decided."""

import json
import os
import time
import unittest

from tests.program import GOOD, LEVELS, MODEL_II, STUDY, ProgramTest, edit

STEP = 'step = "h/4"'
# It is on its way to first order for long.
SLOW = edit(STUDY, MODEL_II, ('"4*h"', '"h^2"'))
PATIENT = edit(SLOW, (LEVELS, '{ from = 16, until = "decided", most = 16384 }'))
PLANNED = ["study", "series", "N", "h", "delta", "dt", "steps", "form", "seconds", "bytes", "key"]


class Forecasts(ProgramTest):
    def explain(self, text, *arguments, **environment):
        self.write("tiny.toml", text)
        environment = {"XDG_CACHE_HOME": str(self.folder / "cache"), **environment}
        return self.acstudy("explain", "tiny.toml", *arguments, env={**os.environ, **environment})

    def plan(self, text, **environment):
        done = self.explain(text, "--json", **environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def test_each_series_and_the_study_have_seconds_and_memory(self):
        done = self.explain(STUDY)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"\n  takes: about (\d[\d.]*|< 0.001) s, \d[\d.]* [kM]B\n")
        self.assertRegex(done.stdout, r"\n1 series, 3 cases: about (\d[\d.]*|< 0.001) s, \d[\d.]* [kM]B; neighbors")

    def test_the_plan_of_a_scheduler(self):
        plan = self.plan(STUDY)
        self.assertEqual([list(case) for case in plan["cases"]], [PLANNED] * 3)
        self.assertEqual([case["N"] for case in plan["cases"]], [16, 32, 64])
        self.assertEqual({case["form"] for case in plan["cases"]}, {"vector"})
        self.assertAlmostEqual(sum(case["seconds"] for case in plan["cases"]), plan["studies"][0]["seconds"])
        self.assertEqual(len({case["key"] for case in plan["cases"]}), 3)

    def test_more_work_takes_longer_and_a_larger_case_more_memory(self):
        cases = self.plan(edit(STUDY, (LEVELS, "[100, 1000, 10000]")))["cases"]
        for quantity in ("seconds", "bytes"):
            values = [case[quantity] for case in cases]
            self.assertEqual(values, sorted(set(values)))

    def test_a_prediction_is_of_the_size_of_what_is_measured(self):
        text = edit(STUDY, (LEVELS, "[640, 1280, 2560]"))
        predicted = self.plan(text)["studies"][0]["seconds"]
        # The lowest of many: what else runs at the same time is not predicted.
        self.run_study(text, "--repeats", "25", "--jobs", "1", expect=0)
        measured = sum(case["seconds_low"] for case in self.result()["series"][0]["cases"])
        self.assertLess(predicted, 10 * measured)
        self.assertGreater(predicted, measured / 10)

    def test_speeds_are_measured_once(self):
        first = self.plan(STUDY)
        kept, = (self.folder / "cache" / "acstudy").iterdir()
        written = kept.stat().st_mtime_ns
        self.assertEqual(self.plan(STUDY), first)
        self.assertEqual(kept.stat().st_mtime_ns, written)
        speeds = json.loads(kept.read_text(encoding="utf-8"))
        kept.write_text(json.dumps({kind: 1000 * value for kind, value in speeds.items()}), encoding="utf-8")
        slower = self.plan(STUDY)["studies"][0]["seconds"] / first["studies"][0]["seconds"]
        self.assertAlmostEqual(slower, 1000, delta=1e-6)
        kept.write_text("{ nonsense", encoding="utf-8")
        self.plan(STUDY)

    def test_a_cache_that_cannot_be_written_is_done_without(self):
        self.write("cache", "no folder")
        self.plan(STUDY)
        self.plan(STUDY, XDG_CACHE_HOME="", HOME="")

    def test_nothing_is_known_of_the_seconds_of_a_program(self):
        scheme = '[[scheme]]\nmodel = 1\ndivergence = "local"\nkernel = "inverse"\n'
        plan = self.plan(edit(STUDY, (scheme, '[[scheme]]\ncommand = ["true"]\norder = 1\n')))
        self.assertEqual([case["seconds"] for case in plan["cases"]], [None] * 3)

    def test_what_cannot_fit_is_refused(self):
        huge = edit(STUDY, (LEVELS, "[16, 100000000]"), ('"4*h"', "1"), ('"forward-euler"', '"backward-euler"'))
        for done in (self.explain(huge), self.acstudy("run", "tiny.toml", "--out", "out")):
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, r"\Aacstudy: tiny\.toml:20:10: N = 100000000 takes about \d+ [TP]B of memory, with "
                                          r"the results of all cases \d+ [TP]B, and there are .*B; leave out the finest")
        self.assertFalse((self.folder / "out").exists())

    def test_time_that_hides_space_is_said_where_a_budget_is_stored(self):
        # Particles that move with the flow: all of the error is that of the steps.
        self.write("tiny.toml", GOOD)
        self.write("parts.toml", '[study]\nname = "parts"\nkind = "pollution"\n[pollution]\nstudies = ["tiny.toml"]\n')
        self.acstudy("run", "parts.toml", "--out", "out")
        said = r"time steps make 100 % of the error of Model I, .* at N = 256, by its error budget"
        self.assertRegex(self.explain(GOOD, "--out", "out").stdout, said)
        self.assertNotRegex(self.explain(GOOD, "--out", "other").stdout, said)
        self.assertNotRegex(self.explain(edit(GOOD, ('"tiny"', '"other"')), "--out", "out").stdout, said)


class Limits(ProgramTest):
    ENDLESS = edit(edit(STUDY, ("[time]", "[[time]]")), (STEP, 'step = "h/4"\nlimit = "0.3 s"'),
                ("[[path]]", '[[time]]\nintegrator = "forward-euler"\nstep = "h/1e8"\nlimit = 0.3\n\n[[path]]'),
                (LEVELS, "[16, 32]"))

    def test_a_case_is_ended_and_the_others_go_on(self):
        for form in ("vector", "readable"):
            with self.subTest(form):
                begin = time.monotonic()
                done = self.run_study(self.ENDLESS, "--form", form, "--jobs", "1", out=form, expect=3)
                self.assertLess(time.monotonic() - begin, 10.0)
                self.assert_counts(done, 4, 0)
                quick, slow = self.result(out=form)["series"]
                self.assertTrue(all(case["error_linf"] > 0.0 for case in quick["cases"]))
                for case in slow["cases"]:
                    self.assertRegex(case["failure"], r"^took longer than its limit of 0\.3 s, at t = .* of 1 with N = ")
                    self.assertIsNone(case["error_linf"])
                    self.assertLess(case["seconds"], 3.0)
                self.assertIn("took longer than its limit of 0.3 s", slow["reason"])

    def test_it_is_run_again_and_the_others_are_not(self):
        self.run_study(self.ENDLESS, expect=3)
        self.assert_counts(self.run_study(self.ENDLESS, expect=3), 2, 2)

    def test_a_limit_that_is_kept_changes_nothing(self):
        self.run_study(STUDY, expect=1)
        done = self.run_study(edit(STUDY, (STEP, STEP + '\nlimit = "1 h"')), expect=1)
        self.assert_counts(done, 0, 3)

    def test_explain_says_it(self):
        self.write("tiny.toml", edit(STUDY, (STEP, STEP + '\nlimit = "2 min"')))
        self.assertIn("step h/4 at most; a case is ended after 120 s\n", self.acstudy("explain", "tiny.toml").stdout)


class Levels(ProgramTest):
    """Levels until the verdict is decided."""

    def levels(self, out="out"):
        return [case["N"] for case in self.result(out=out)["series"][0]["cases"]]

    def test_levels_are_added_until_the_verdict_is_decided(self):
        self.run_study(PATIENT)
        series, = self.result()["series"]
        levels = self.levels()
        self.assertEqual(levels, [16 * 2 ** k for k in range(len(levels))])
        self.assertEqual(series["cases_planned"], len(levels))
        self.assertNotIn(series["verdict"], ("inconclusive", "pre-asymptotic"))
        # With a level less it was not decided, and with these it is the same.
        for fewer, decided in ((0, True), (1, False)):
            listed = [str(N) for N in levels[:len(levels) - fewer]]
            self.run_study(edit(SLOW, (LEVELS, f"[{', '.join(listed)}]")), out="listed")
            verdict = self.result(out="listed")["series"][0]["verdict"]
            self.assertEqual(verdict not in ("inconclusive", "pre-asymptotic"), decided)
        self.assertGreater(len(levels), 4)
        self.assertLess(levels[-1], 16384)

    def test_a_verdict_that_stays_open_ends_at_most(self):
        self.run_study(edit(PATIENT, ("16384", "255")))
        self.assertEqual(self.levels(), [16, 32, 64, 128])

    def test_what_is_stored_is_not_run_again(self):
        self.run_study(PATIENT)
        count, before = len(self.levels()), self.result()["series"]
        self.assert_counts(self.run_study(PATIENT), 0, count)
        self.assertEqual(self.result()["series"], before)
        self.assert_counts(self.run_study(PATIENT, "--fresh"), count, 0)
        # The coarse ones are those of the list.
        self.assert_counts(self.run_study(SLOW, out="coarse"), 3, 0)
        self.assert_counts(self.run_study(PATIENT, out="coarse"), count - 3, 3)

    def test_threads_change_nothing(self):
        wide = PATIENT + '\n[[path]]\nname = "delta = 2h"\ndelta = "2*h"\nsource = "local"\n' \
            'N = { from = 16, until = "decided", most = 1024 }\n\n[[scheme]]\nmodel = 2\ndivergence = "nonlocal"\n' \
            'kernel = "cubic-spline"\n'
        results = []
        for jobs in ("1", "3"):
            self.run_study(wide, "--jobs", jobs, out=jobs)
            results.append([[(case["N"], case["error_linf"]) for case in series["cases"]]
                            for series in self.result(out=jobs)["series"]])
        self.assertEqual(len(results[0]), 4)
        self.assertEqual(results[0], results[1])

    def test_explain_says_it(self):
        self.write("tiny.toml", PATIENT)
        self.assertIn("\n  from N = 256 on a level is added where the verdict is not decided without it\n",
                      self.acstudy("explain", "tiny.toml").stdout)
        cases = json.loads(self.acstudy("explain", "--json", "tiny.toml").stdout)["cases"]
        self.assertEqual([case["N"] for case in cases if case.get("if_undecided")], [256, 512, 1024, 2048, 4096, 8192, 16384])


if __name__ == "__main__":
    unittest.main()
