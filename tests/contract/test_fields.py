"""Fields that are not finite are named, with their place, and not blamed on the scheme."""

import unittest

from tests.program import INLINE, ProgramTest, edit

C, B, U = '"cos(2*x)/3"', '"sin(x)"', '"cos(x-t)"'
SMOOTH = "sources are made of it: write a field that has a derivative there"
# A standing scene whose u has no derivative at x = t + 0.1, where a particle is at T/2.
LATER = edit(INLINE, ('b = "sin(x)"\n', ""), ('flow = "2*atan2(sin(x/2)*exp(t), cos(x/2))"', ""),
             (U, '"sqrt(1 - cos(x - t - 0.1)^2)"'), ("T = 1", 'T = "pi/4 - 0.2"'), ('step = "h/4"', 'step = "(pi/4 - 0.2)/4"'))


class FieldTest(ProgramTest):
    def refused(self, *changes):
        done = self.run_study(edit(INLINE, *changes), expect=2)
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual((done.stdout, done.stderr.count("\n")), ("", 1))
        return done.stderr

    def test_values(self):
        self.assertIn("tiny.toml:8:6: c is inf at x = 0; it must be finite everywhere", self.refused((C, '"1/sin(x)"')))

    def test_poles(self):
        """Wherever they are, and though no double is exactly there."""
        for field in ("tan(x)", "1/cos(x)", "1/sin(x - 0.3)", "1/(1 - cos(x - 1))"):
            with self.subTest(field):
                self.assertRegex(self.refused((C, f'"{field}"')), r"tiny.toml:8:\d: c (has a pole at|is inf at) x = [\d.]+")
        self.assertRegex(self.refused((U, '"1/sin(x - t - 0.3)"')), r"10:\d: u has a pole at x = [\d.]+, t = 0: ")

    def test_derivatives(self):
        self.assertIn(f"tiny.toml:10:6: the derivative of u by x is nan at x = 0, t = 0; {SMOOTH}",
                      self.refused((U, '"sqrt(1 - cos(x-t)^2)"')))
        self.assertRegex(self.refused((C, '"sqrt(1 - cos(x)^2)"')), r"8:6: the derivative of c by x is nan at x = 0; ")

    def test_sharp_fields_are_taken(self):
        for field in ("1/(1e-6 + sin(x)^2)", "exp(-1e5*(1 - cos(x - 1)))", "abs(sin(x))", "1e300*cos(x)", "0", 
                      "tanh(1e4*sin(x))"):
            with self.subTest(field):
                self.write("tiny.toml", edit(INLINE, (C, f'"{field}"')))
                done = self.acstudy("explain", "tiny.toml")
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_what_no_sample_shows(self):
        """The failure of the run names field and place, in both forms."""
        for form in ("vector", "readable"):
            with self.subTest(form):
                self.run_study(LATER, "--form", form, "--fresh", expect=3)
                [series] = self.result()["series"]
                self.assertEqual(series["verdict"], "inconclusive")
                self.assertRegex(series["reason"],
                                 r"the derivative of u by . is \S+ at x = [\d.]+, t = [\d.]+, where particle")
                self.assertNotIn("blow_up", series["cases"][0])
                self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 1)


if __name__ == "__main__":
    unittest.main()
