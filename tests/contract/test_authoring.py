"""acstudy init and acstudy schema: a study to begin with, and what an editor knows of all of them."""

import json
import unittest

from tests.program import ROOT, STUDY, ProgramTest, edit

try:
    import tomllib
except ImportError:
    tomllib = None
try:
    import jsonschema
except ImportError:
    jsonschema = None


class InitTest(ProgramTest):
    def test_the_study_runs_as_it_is(self):
        done = self.acstudy("init", "mine")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("mine.toml", done.stdout)
        done = self.acstudy("run", "mine.toml", "--out", "out")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.acstudy("check", "out/mine.json").returncode, 0)

    def test_what_is_there_is_not_replaced(self):
        self.write("mine.toml", "kept")
        done = self.acstudy("init", "mine.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("mine.toml: is there already", done.stderr)
        self.assertEqual((self.folder / "mine.toml").read_text(encoding="utf-8"), "kept")

    def test_a_name_that_no_study_can_have_is_refused(self):
        done = self.acstudy("init", "My Study")
        self.assertEqual(done.returncode, 2)
        self.assertIn("a-z, 0-9 and - only", done.stderr)
        self.assertFalse((self.folder / "My Study.toml").exists())


@unittest.skipUnless(jsonschema and tomllib, "there is no jsonschema, or Python is older than 3.11")
class SchemaTest(ProgramTest):
    def setUp(self):
        super().setUp()
        schema = json.loads(self.acstudy("schema").stdout)
        jsonschema.Draft7Validator.check_schema(schema)
        self.validator = jsonschema.Draft7Validator(schema)

    def errors(self, text):
        return [error.message for error in self.validator.iter_errors(tomllib.loads(text))]

    def test_all_studies_are_valid(self):
        studies = sorted((ROOT / "studies").rglob("*.toml"))
        self.assertGreater(len(studies), 30)
        for study in studies:
            with self.subTest(study=study.name):
                self.assertEqual(self.errors(study.read_text(encoding="utf-8")), [])

    def test_what_a_reader_refuses_is_seen(self):
        self.assertEqual(self.errors(STUDY), [])
        for old, new in (("[time]", "[tim]"), ("step =", "steps ="), ('"local"\nkernel', '"both"\nkernel'),
                         ("model = 1", "model = 1.5"), ('"inverse"', '"inverted"'), ('"inverse"', '{ nam = "power" }'),
                         ("[16, 32, 64]", "[]"), ('name = "tiny"', 'name = "tiny"\nkind = "covergence"'),
                         ('name = "tiny"', 'name = "tiny"\nkind = "identities"'), ("[study]", "[a]\nb = 1\n\n[study]"),
                         ('integrator = "forward-euler"', 'integrator = "euler"')):
            with self.subTest(new=new):
                text = edit(STUDY, (old, new)) if STUDY.count(old) == 1 else STUDY.replace(old, new, 1)
                self.assertNotEqual(self.errors(text), [])
                self.write("wrong.toml", text)
                self.assertEqual(self.acstudy("explain", "wrong.toml").returncode, 2)


if __name__ == "__main__":
    unittest.main()
