"""Models and kernels each have one home."""

import re
import unittest

from tests.program import ROOT

CARDS = re.compile(r"studies/models/model(\w+|_card)\.[ch]pp$")
ASKS = re.compile(r"\bmodel(_|->number|\.number)?\s*[!=]=\s*(\d|&model_\w+)|\bnumber\s*[!=]=\s*\d|case \d+:.*[Mm]odel")


def questions(text):
    """Lines of a source that ask for one model by its number or its card."""
    return [line.strip() for line in text.splitlines() if ASKS.search(line)]


def sources():
    return [path.relative_to(ROOT) for top in ("solver", "mms", "reports", "studies", "bench")
            for path in sorted((ROOT / top).rglob("*.?pp"))]


class Models(unittest.TestCase):
    """What is of one model stands in its card: nothing else asks which model it has before it."""

    def test_no_source_but_a_card_asks_for_one_model(self):
        self.assertGreater(len(sources()), 100)
        self.assertGreaterEqual(len([file for file in sources() if CARDS.search(str(file))]), 4)
        found = {str(file): asked for file in sources() if not CARDS.search(str(file))
                 if (asked := questions((ROOT / file).read_text(encoding="utf-8")))}
        self.assertEqual(found, {})

    def test_a_source_that_asks_is_seen(self):
        for line in ("if (scheme.model == 1) return;", "const bool second = c.scheme.model != 2;",
                     "if (model_ == 1) {", "return scheme.model->number == 2;", "x = choice.model == &model_one;"):
            self.assertEqual(questions(line), [line])

    def test_naming_a_card_or_asking_what_it_can_is_no_question(self):
        for line in ("Subject{.model = &model_two}", "if (scheme.model->upwind) return;",
                     "control->model == scheme.model", "model = 1  # in a study"):
            self.assertEqual(questions(line), [])


REGISTRY = "studies/models/kernel_choice.hpp"


class Kernels(unittest.TestCase):
    """The name of a kernel stands in its row: nothing else knows it."""

    def setUp(self):
        rows = re.findall(r'\.name = "([a-z0-9-]+)",\s+\.written', (ROOT / REGISTRY).read_text(encoding="utf-8"))
        self.assertGreaterEqual(len(rows), 3)
        self.names = re.compile("|".join(rf'"{row}\\?"' for row in rows))

    def test_no_source_but_the_registry_names_a_kernel(self):
        found = {str(file): named for file in sources() if str(file) != REGISTRY
                 if (named := self.names.findall((ROOT / file).read_text(encoding="utf-8")))}
        self.assertEqual(set(found.pop("studies/commands/authoring/first_study.cpp")),  # a study
                         {'"inverse"', '"power"', '"cubic-spline"'})
        self.assertEqual(found, {"studies/claims/extremes_shapes.cpp": ['"hat"']})  # a shape of u

    def test_a_source_that_names_one_is_seen(self):
        for line in ('if (kernel.name == "power") return;', 'fail("write \\"cubic-spline\\"")', '{"inverse"}'):
            self.assertEqual(len(self.names.findall(line)), 1, line)
        self.assertEqual(self.names.findall('text("the power kernel of the inverse")'), [])
