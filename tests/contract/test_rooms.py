"""Includes and imports point one way: a room knows those before it, and none after it."""

import re
import unittest

from tests.program import ROOT

ROOMS = ["solver", "mms", "reports/judging", "studies/models", "studies/cases", "studies/reading", "studies/storing",
         "studies/running", "studies/claims", "studies/kinds", "studies/commands"]
PYTHON_ROOMS = ["reading", "drawing", "writing", "kinds", "pages"]  # of reports/
# What is of any dimension includes nothing that needs a line.
ANY_DIMENSION = ["solver/time", "solver/rate_matrix.hpp", "solver/velocity.hpp", "mms/points.?pp", "mms/expression.?pp",
                 "mms/scene.?pp", "mms/source.hpp", "mms/nonlocal_source.hpp", "studies/cases/case_result.hpp",
                 "studies/running/outcome.hpp"]
IMPORT = re.compile(rf"^\s*(?:from|import) ({'|'.join(PYTHON_ROOMS)})\b", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def room_of(path):
    return next((room for room in ROOMS if path.startswith(room + "/")), None)


def wrong_ways(file, text):
    """Includes of a source that lead to a later room."""
    here = ROOMS.index(room_of(file))
    return [include for include in INCLUDE.findall(text)
            if (room := room_of(include)) is not None and ROOMS.index(room) > here]


def wrong_imports(room, text):
    """Rooms of reports/ that a Python file of `room` imports although they are later ones."""
    return [other for other in IMPORT.findall(text) if PYTHON_ROOMS.index(other) > PYTHON_ROOMS.index(room)]


class Rooms(unittest.TestCase):
    def sources(self):
        return [path.relative_to(ROOT) for top in ("solver", "mms", "reports", "studies")
                for path in sorted((ROOT / top).rglob("*.?pp"))]

    def test_each_source_stands_in_a_room(self):
        self.assertGreater(len(self.sources()), 100)
        self.assertEqual([str(file) for file in self.sources() if room_of(str(file)) is None], [])

    def test_no_include_leads_to_a_later_room(self):
        found = {str(file): wrong for file in self.sources()
                 if (wrong := wrong_ways(str(file), (ROOT / file).read_text(encoding="utf-8")))}
        self.assertEqual(found, {})

    def test_an_include_that_leads_to_a_later_room_is_seen(self):
        self.assertEqual(wrong_ways("studies/cases/case.hpp", '#include "studies/running/run_case.hpp"\n'),
                         ["studies/running/run_case.hpp"])
        self.assertEqual(wrong_ways("studies/running/run_case.hpp", '#include "studies/cases/case.hpp"\n'), [])

    def test_what_is_of_any_dimension_includes_nothing_of_a_line(self):
        files = [file for pattern in ANY_DIMENSION for path in ROOT.glob(pattern)
                 for file in (path.iterdir() if path.is_dir() else [path])]
        self.assertGreater(len(files), 14)
        found = {str(file.relative_to(ROOT)): of_line for file in files
                 if (of_line := [include for include in INCLUDE.findall(file.read_text(encoding="utf-8"))
                                 if "/line/" in include])}
        self.assertEqual(found, {})

    def test_no_import_of_a_report_leads_to_a_later_room(self):
        files = [(room, path) for room in PYTHON_ROOMS for path in sorted((ROOT / "reports" / room).rglob("*.py"))]
        self.assertGreater(len(files), 30)
        found = {str(path): wrong for room, path in files
                 if (wrong := wrong_imports(room, path.read_text(encoding="utf-8")))}
        self.assertEqual(found, {})

    def test_an_import_that_leads_to_a_later_room_is_seen(self):
        self.assertEqual(wrong_imports("reading", "from kinds import registry\n"), ["kinds"])
        self.assertEqual(wrong_imports("reading", "    import pages.page\n"), ["pages"])
        self.assertEqual(wrong_imports("pages", "from kinds import registry\nimport re\n"), [])
