"""acstudy explain says what a manufactured solution cannot show; each warning with a scene that earns it, and one that
does not."""

import unittest

from tests.program import GOOD, INLINE, LEVELS, ProgramTest, edit

HEADING = "what its solution cannot show:\n"


class LintTest(ProgramTest):
    def warnings(self, text):
        self.write("study.toml", text)
        done = self.acstudy("explain", "study.toml")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        _, found, lines = done.stdout.partition(HEADING)
        return lines if found else ""

    def test_the_papers_scene_has_none(self):
        self.assertEqual(self.warnings(INLINE), "")

    def test_each_is_said_of_a_scene_that_earns_it_alone(self):
        flow = '\nflow = "2*atan2(sin(x/2)*exp(t), cos(x/2))"'
        for said, *changes in (
                ("c is constant", ('c = "cos(2*x)/3"', "c = 0.2")),
                ("b is constant", ('b = "sin(x)"' + "\n" + 'u = "cos(x-t)"' + flow, 'b = 0.1\nu = "cos(x-t)"')),
                ("u does not depend on t", ('"cos(x-t)"', '"cos(x)"')),
                ("never looks to the right", ('c = "cos(2*x)/3"', 'c = "3 + cos(2*x)/3"')),
                ("never looks to the left", ('c = "cos(2*x)/3"', 'c = "cos(2*x)/3 - 3"')),
                ("of which there are 5 in a period; begin at N = 40", ('"cos(x-t)"', '"cos(5*(x-t))"')),
                ("drives the solution", ('"cos(x-t)"', '"cos(x-20*t)"'))):
            with self.subTest(said=said):
                lines = self.warnings(edit(INLINE, *changes))
                self.assertIn(said, lines)
                self.assertEqual(lines.count("\n  - ") + lines.startswith("  - "), 1, lines)

    def test_a_solution_that_a_scheme_reproduces(self):
        # Where particles move with the flow, c - b is zero, and so is all that a scheme computes.
        self.assertIn("reproduces u exactly at N = 32", self.warnings(GOOD))

    def test_none_is_said_where_no_solution_is_known(self):
        self.assertEqual(self.warnings(edit(INLINE, ('u = "cos(x-t)"', 'reference = "finest"\nu0 = "cos(5*x)"'),
                                            (LEVELS, "[16, 32, 64, 128]"))), "")


if __name__ == "__main__":
    unittest.main()
