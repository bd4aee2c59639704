"""What is of one model stands in its card: nothing else asks which model it has before it."""

import re
import unittest

from tests.program import ROOT

CARDS = re.compile(r"studies/models/model(\w+|_card)\.[ch]pp$")
ASKS = re.compile(r"\bmodel(_|->number|\.number)?\s*[!=]=\s*(\d|&model_\w+)|\bnumber\s*[!=]=\s*\d|case \d+:.*[Mm]odel")


def questions(text):
    """Lines of a source that ask for one model by its number or its card."""
    return [line.strip() for line in text.splitlines() if ASKS.search(line)]


class Models(unittest.TestCase):
    def sources(self):
        return [path.relative_to(ROOT) for top in ("solver", "mms", "reports", "studies", "bench")
                for path in sorted((ROOT / top).rglob("*.?pp"))]

    def test_no_source_but_a_card_asks_for_one_model(self):
        self.assertGreater(len(self.sources()), 100)
        self.assertEqual(len([file for file in self.sources() if CARDS.search(str(file))]), 4)
        found = {str(file): asked for file in self.sources() if not CARDS.search(str(file))
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
