"""Values beyond a limit, and long ones: bad input, said in a line that can be read."""

import unittest

from tests.program import INLINE, STUDY, USE, ProgramTest, edit

NAME = '"tiny"'
WAVES = "+".join(["cos(2*x)"] * 1500)   # 13499 letters
SHOWN = '"' + WAVES[:60] + '..." (13499 letters)'


class LimitTest(ProgramTest):
    def assert_refused(self, study, message):
        self.assert_bad_input(self.run_study(study), f"tiny.toml:{message}")
        self.assertFalse((self.folder / "out").exists())

    def test_names_of_studies(self):
        self.run_study(edit(STUDY, (NAME, f'"{"a" * 200}"')), expect=1)
        self.assertTrue((self.folder / "out" / f"{'a' * 200}.h5").exists())
        for length in (201, 300):
            shown = f'"{"a" * 60}..." ({length} letters)'
            with self.subTest(length):
                done = self.run_study(edit(STUDY, (NAME, f'"{"a" * length}"')), out="other")
                self.assert_bad_input(done, f"tiny.toml:2:8: name = {shown}; it names result files and may have at most "
                                            "200 letters: write a shorter one")

    def test_long_expressions(self):
        too_long = f"the expression {SHOWN} is too long; the most is 10000 letters: write a shorter one"
        self.assert_refused(edit(INLINE, ("cos(2*x)/3", WAVES)), f"8:6: {too_long}")
        waves = WAVES.replace("x", "h")
        self.assert_refused(edit(STUDY, ('"4*h"', f'"{waves}"')), f"19:10: delta: {too_long.replace('x)', 'h)')}")

    def test_long_values(self):
        long = "b" * 5000
        shown = f'"{long[:60]}..." (5000 letters)'
        for old, new, message in (
                (USE, f'use = "{long}"', f"6:7: unknown scene {shown}; known scenes: "),
                ('"inverse"', f'"{long}"', f"11:10: unknown kernel {shown}; known kernels: "),
                ('source = "local"', f'source = "{long}"', f"21:10: source = {shown}; it must be one of "),
                ("model = 1", f'model = "{long}"', f'9:9: model = {shown}; it must be 1 or 2 or "slopes" or "symmetric"'),
                ("source =", f"{long} =", f"21:1: unknown key {shown} in [[path]]; known keys: "),
                ('"4*h"', f'"{long}"', f"19:10: delta = {shown}: unknown name {shown}; it may use "),
                ('"4*h"', f'"4*h*{"(" * 5000}"', '19:')):
            with self.subTest(message):
                done = self.run_study(edit(STUDY, (old, new)), expect=2)
                self.assertIn(f"acstudy: tiny.toml:{message}", done.stderr)
                self.assertLess(len(done.stderr), 500)
                self.assertEqual(done.stderr.count("\n"), 1)

    def test_a_long_name_of_another_study(self):
        long = "c" * 300
        done = self.run_study(f'[study]\nname = "p"\nkind = "pollution"\n[pollution]\nstudies = ["{long}"]\n', expect=2)
        self.assertIn(f'studies contains "{long[:60]}..." (300 letters), but there is no such file', done.stderr)

    def test_numbers_of_the_command_line(self):
        self.write("tiny.toml", STUDY)
        for command, option, values in (("bench", "--least-seconds", ("nan", "-nan", "inf", "-1", "3601")),
                                        ("bench", "--runs", ("nan", "inf", "0")), ("bench", "--threads", ("nan", "1,inf")),
                                        ("run", "--jobs", ("nan", "inf", "0")), ("run", "--repeats", ("nan", "-inf"))):
            for value in values:
                with self.subTest(f"{option} {value}"):
                    done = self.acstudy(command, "tiny.toml", "--out", "out", f"{option}={value}")
                    self.assertEqual((done.returncode, done.stdout), (2, ""))
                    self.assertRegex(done.stderr, rf"^acstudy: .*{option}.*{value.split(',')[-1]}")
        self.assertFalse((self.folder / "out").exists())

    def test_numbers_of_a_study(self):
        """Every number of a study is finite."""
        power = '{ name = "power", alpha = 0.5 }'
        for old, new, key in (('"inverse"', power.replace("0.5", "@"), "alpha"), ('"4*h"', "@", "delta"),
                              ('"h/4"', "@", "step"), (USE, USE + "\nT = @", "T"),
                              ('source = "local"', 'source = "local"\norder = @', "order"),
                              ('source = "local"', 'source = "local"\n'
                               'start = { name = "jittered", smallest_gap = @, seed = 1 }', "smallest_gap")):
            for value in ("nan", "inf", "-inf"):
                with self.subTest(key, value=value):
                    done = self.run_study(edit(STUDY, (old, new.replace("@", value))), expect=2)
                    self.assertRegex(done.stderr, rf"^acstudy: tiny.toml:\d+:\d+: {key} = {value}; it must be finite\n$")


if __name__ == "__main__":
    unittest.main()
