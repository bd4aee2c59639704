"""The digest that decides whether a stored result is taken again follows the sources that the result rests on."""

import os
from pathlib import Path
import re
import shutil
import subprocess
import tempfile
import unittest

from tests.program import ACSTUDY, ROOT

BUILD = ACSTUDY.parent
SCRIPT = Path("cmake", "source_digest.cmake")
# What the sources behind a digest may rest on besides: no case is run by the judge.
BESIDES = {"numerics": ("reports/judging/",), "measurements": ()}


def digest(root, of):
    """The digest of the sources under `root`, and these sources."""
    done = subprocess.run(["cmake", f"-DROOT={root}", f"-DOF={of}", "-P", root / SCRIPT], text=True,
                          capture_output=True, check=True)
    value, *sources = done.stdout.split()
    return value, sources


def symbols(objects, *options):
    """Names in the symbol tables of object files."""
    done = subprocess.run(["nm", "--format=posix", *options, *objects], text=True, capture_output=True, check=True)
    return [line.split()[:2] for line in done.stdout.splitlines() if len(line.split()) > 1]


class EditTest(unittest.TestCase):
    """An edit in a copy of the sources."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for part in ("cmake", "mms", "reports", "solver", "studies"):
            shutil.copytree(ROOT / part, self.root / part)
        self.before = {of: digest(self.root, of)[0] for of in ("numerics", "measurements")}

    def changed(self, file):
        """Which digests an edit of the file changes."""
        path = self.root / file
        text = path.read_text(encoding="utf-8")
        path.write_text(text + "\n", encoding="utf-8")
        changed = {of for of, value in self.before.items() if digest(self.root, of)[0] != value}
        path.write_text(text, encoding="utf-8")
        return changed

    def test_what_decides_numbers(self):
        for file in ("studies/models/arrangement.cpp", "studies/running/watch.hpp", "studies/cases/case.hpp",
                     "studies/running/ensemble/team.cpp", "solver/line/far/far_sweeps_isa.cpp",
                     "mms/line/source_series.cpp"):
            with self.subTest(file):
                self.assertEqual(self.changed(file), {"numerics", "measurements"})

    def test_what_measures_only(self):
        for file in ("reports/judging/orders.cpp", "reports/judging/fits.hpp", "studies/claims/extremes_mass.cpp",
                     "studies/kinds/map.cpp", "studies/reading/study_parts.cpp"):
            with self.subTest(file):
                self.assertEqual(self.changed(file), {"measurements"})

    def test_what_does_neither(self):
        for file in ("studies/commands/fit/fit.cpp", "studies/commands/main.cpp", "studies/commands/run/runner.cpp",
                     "reports/report.py", "studies/fig2.toml", "studies/storing/bench_store.cpp"):
            with self.subTest(file):
                self.assertEqual(self.changed(file), set())

    def test_a_new_file_counts(self):
        (self.root / "solver/new.hpp").write_text("", encoding="utf-8")
        for of in ("numerics", "measurements"):
            self.assertNotEqual(digest(self.root, of)[0], self.before[of])


@unittest.skipUnless((BUILD / "CMakeCache.txt").exists(), "the program does not stand in its build folder")
class BuildTest(unittest.TestCase):
    """The digest's sources against what the compiler read and the linker needs."""

    @classmethod
    def setUpClass(cls):
        cls.objects = {}  # of every source of the program; some are compiled several times
        for target in (BUILD / "CMakeFiles").glob("acstudy*.dir"):
            for file in target.rglob("*.o"):
                for source in cls.sources_of(file, target):
                    cls.objects.setdefault(source, []).append(file)
        cls.read = {}  # by object: the project's files that the compiler read
        if (BUILD / "build.ninja").exists():
            done = subprocess.run(["ninja", "-C", BUILD, "-t", "deps"], text=True, capture_output=True, check=True)
            for block in done.stdout.split("\n\n"):
                head, *files = block.splitlines()
                cls.read[BUILD / head.split(": #deps")[0]] = cls.of_the_project(files)
        else:
            for file in set(sum(cls.objects.values(), [])):
                text = Path(f"{file}.d").read_text(encoding="utf-8").replace("\\\n", " ")
                names = re.split(r"(?<!\\)\s+", text.split(":", 1)[1].strip())
                cls.read[file] = cls.of_the_project(name.replace("\\ ", " ") for name in names)

    @staticmethod
    def sources_of(file, target):
        """What an object is made of: a source, or those of a folder that are read as one."""
        if file.parent.name != "Unity":
            return [str(file.relative_to(target))[:-2]]
        together = file.with_suffix("").read_text(encoding="utf-8")
        return [os.path.relpath(source, ROOT) for source in re.findall(r'#include "(.*)"', together)]

    @staticmethod
    def of_the_project(names):
        paths = [os.path.normpath(os.path.join(BUILD, name.strip())) for name in names]
        return {os.path.relpath(path, ROOT) for path in paths
                if path.startswith(f"{ROOT}{os.sep}") and not path.startswith(f"{BUILD}{os.sep}")}

    def test_the_program_has_these_digests(self):
        header = (BUILD / "generated" / "build_info.hpp").read_text(encoding="utf-8")
        for of in ("numerics", "measurements"):
            self.assertIn(f'{of} = "{digest(ROOT, of)[0]}"', header)

    def test_every_file_that_the_compiler_read_is_in_it(self):
        for of, besides in BESIDES.items():
            sources = set(digest(ROOT, of)[1])
            compiled = [file for file in sources if file.endswith(".cpp")]
            read = set().union(*(self.read[file] for source in compiled for file in self.objects[source]))
            self.assertGreaterEqual(len(compiled), 20)
            self.assertEqual({file for file in read - sources if not file.startswith(besides)}, set(), of)

    def test_no_symbol_comes_from_outside(self):
        defined_in = {}
        for source, objects in self.objects.items():
            for name, kind in symbols(objects, "--defined-only", "--extern-only"):
                if kind in "TDBR":  # weak ones are inline functions, which each file that uses them has
                    defined_in[name] = source
        for of, besides in BESIDES.items():
            sources = set(digest(ROOT, of)[1])
            used = [name for source in sources if source.endswith(".cpp")
                    for name, kind in symbols(self.objects[source], "--undefined-only")]
            self.assertEqual({(name, defined_in[name]) for name in used
                              if name in defined_in and not (defined_in[name] in sources
                                                             or defined_in[name].startswith(besides))}, set(), of)


if __name__ == "__main__":
    unittest.main()
