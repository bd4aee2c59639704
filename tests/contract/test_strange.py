"""What strange studies and command lines come to: nothing is lost, and what is refused is refused with its place."""

import os
import resource
import unittest

from tests.program import LEVELS, STUDY, ProgramTest, edit

NAME = '"tiny"'
SWEEP = STUDY[:STUDY.index("[time]")].replace("model = 1", "model = 2").replace('"inverse"', '"cubic-spline"')


class Strange(ProgramTest):
    def refused(self, text, message):
        self.assert_bad_input(self.run_study(text), f"tiny.toml:{message}")

    def test_names(self):
        self.refused(edit(STUDY, (NAME, '"bench"')),
                     '2:8: name = "bench"; acstudy bench gives that name to its files, choose another')
        for name in ("-", "--help"):
            self.refused(edit(STUDY, (NAME, f'"{name}"')), f'2:8: name = "{name}"; a command would take {name}.json for '
                                                           "an option: begin with a letter or a digit")
        self.refused(edit(STUDY, ('"delta = 4h"', f'"{"p" * 5000}"')),
                     f'18:8: name = "{"p" * 60}..." (5000 letters); a path may have at most 200 letters: write a shorter one')

    def test_sweeps_of_too_few_particles(self):
        def sweep(kind, N, ratio):
            return SWEEP.replace('title = "A tiny study"', f'kind = "{kind}"') + f"[sweep]\nN = [{N}]\nratios = [{ratio}]\n"

        self.refused(sweep("identities", 7, 3.5), "14:5: N = 7; a study of this kind looks at horizons that are half the "
                     "period or more with fewer than 9 particles: leave it out")
        self.refused(sweep("stability", 3, 1), "14:5: N = 3; a study of this kind looks at horizons that are half the "
                     "period or more with fewer than 4 particles: leave it out")
        self.refused(sweep("identities", 10, 5), "15:10: none of these horizons stays below half the period at N = 10; "
                     "write a ratio below 5")

    def test_levels_that_hardly_refine_confirm_nothing(self):
        self.run_study(edit(STUDY, (LEVELS, "[1000, 1001, 1002, 1003]")), expect=1)
        series = self.result()["series"][0]
        self.assertEqual(series["verdict"], "inconclusive")
        self.assertIn("the variable falls by a factor of 1 in all; an order takes 1.2 at least", series["reason"])

    def test_a_long_command_line(self):
        self.write("tiny.toml", STUDY)
        done = self.acstudy("run", "tiny.toml", "--out", "./" * 40000 + "out")
        self.assertEqual(done.returncode, 2)  # no path is as long as that
        done = self.acstudy("run", "tiny.toml", "--out", "./" * 1000 + "out")
        self.assertEqual(done.returncode, 1, done.stderr)
        for i in range(700):
            self.write(f"a-rather-long-name-of-a-folder-so-that-the-line-is-longer-than-64-kB-{i}.toml",
                       edit(STUDY, (NAME, f'"s{i}"'), (LEVELS, "[16]")))
        files = sorted(os.listdir(self.folder))
        files = [str(self.folder / name) for name in files if name.startswith("a-rather")][:700]
        done = self.acstudy("run", *files, "--out", "many", "--quiet")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(len(list((self.folder / "many").iterdir())), 1400)
        self.assertRegex(self.result("s0", "many")["provenance"]["command"], r"\.\.\. \(\d{5,} letters\)\Z")

    def test_the_other_form_is_not_dropped(self):
        self.run_study(STUDY)
        done = self.run_study(STUDY, "--form", "readable", expect=2)
        self.assertIn("out/tiny.h5: holds results of the vector form, which would be dropped", done.stderr)
        self.assert_counts(self.run_study(STUDY), 0, 3)
        self.assert_counts(self.run_study(STUDY, "--form", "readable", "--fresh"), 3, 0)

    def test_a_file_of_the_same_name_is_not_read(self):
        os.mkfifo(self.folder / "tiny.h5")  # whoever opens it waits for ever
        self.assert_counts(self.run_study(STUDY), 3, 0)

    def test_one_case_beyond_the_memory_is_refused(self):
        def little():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

        done = self.run_study(edit(STUDY, (LEVELS, "[16, 32, 100000000]")), preexec_fn=little)
        self.assertEqual(done.returncode, 2)
        self.assertIn("tiny.toml:20:", done.stderr)
        self.assertIn("N = 100000000 takes about", done.stderr)


if __name__ == "__main__":
    unittest.main()
