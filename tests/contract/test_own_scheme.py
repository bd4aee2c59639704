"""A scheme from outside: built against an installed acstudy, named by studies, examined by every kind that can."""

import json
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
import unittest

from tests.program import ACSTUDY, ROOT, edit, install

EXAMPLE = ROOT / "examples" / "scheme"
LAST_CELL = ("? p.first_moment(0.5 * (d + std::abs(p.z(side * (k + 1))))) : 1.0;",
             "? p.first_moment(0.5 * (d + std::abs(p.z(side * (k + 1))))) : p.first_moment(d);")
SOLVER_ALONE = """
#include <cstdio>
#include "solver/kernels.hpp"
#include "solver/line/particles.hpp"
int main() {
  acstudy::Particles particles(8, 1.0, 0.3);
  std::puts(particles.size() == 8 && acstudy::InverseKernel{}.first_moment(1.0) == 1.0 ? "right" : "wrong");
}
"""


def do(*command, folder=None, code=0):
    done = subprocess.run([str(word) for word in command], cwd=folder, text=True, capture_output=True, check=False,
                          timeout=600)
    if done.returncode != code:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class OwnScheme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.prefix = cls.folder / "prefix"
        if not install(cls.prefix):
            raise unittest.SkipTest("the program does not stand in a build folder")
        cls.right = cls.build(EXAMPLE, "right")

    @classmethod
    def build(cls, source, name):
        folder = cls.folder / name
        do("cmake", "-S", source, "-B", folder, f"-DCMAKE_PREFIX_PATH={cls.prefix}", "-DCMAKE_BUILD_TYPE=Release")
        do("cmake", "--build", folder)
        return folder / "my-acstudy"

    def results(self, program, *studies, code=0):
        out = self.folder / f"out-{program.parent.name}"
        do(program, "run", *(EXAMPLE / f"{study}.toml" for study in studies), "--out", out, code=code)
        return {study: json.loads((out / f"own-{study}.json").read_text(encoding="utf-8")) for study in studies}

    def test_the_header_is_short_and_one_line_registers(self):
        lines = (EXAMPLE / "renormalized_upwind.hpp").read_text(encoding="utf-8").splitlines()
        self.assertLess(len(lines), 60)

    def test_it_converges_and_another_acstudy_judges_its_results(self):
        result = self.results(self.right, "convergence")["convergence"]
        for series in result["series"]:
            with self.subTest(series["subject"], path=series["path"]):
                self.assertIn(series["verdict"], ("confirmed", "pre-asymptotic"))
        self.assertEqual(result["series"][0]["label"], "renormalized-upwind")
        out = self.folder / "out-right"
        do(ACSTUDY, "check", out / "own-convergence.json")
        self.assertIn("renormalized-upwind", do(ACSTUDY, "table", out / "own-convergence.json"))

    def test_it_is_examined_by_every_kind_that_can(self):
        results = self.results(self.right, "consistency", "stability", "controls")
        for study, result in results.items():
            with self.subTest(study):
                self.assertGreater(len(result["findings"]), 3)
                self.assertTrue(all(finding["as_expected"] for finding in result["findings"]))
        claimed = [f for f in results["stability"]["findings"] if f["promised"] == "holds"]
        self.assertGreater(len(claimed), 3)

    def test_kinds_that_measure_what_theory_says_of_the_paper_refuse_it(self):
        study = edit((EXAMPLE / "consistency.toml").read_text(encoding="utf-8"), ("consistency\"\n\n", "identities\"\n\n"))
        file = self.folder / "identities.toml"
        file.write_text(study[:study.index("[[path]]")], encoding="utf-8")
        done = subprocess.run([self.right, "explain", file], text=True, capture_output=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("identities.toml:10:9: a study of kind identities measures what theory says", done.stderr)

    def test_a_mistake_is_noticed_and_its_results_are_not_taken_for_those_of_the_right_one(self):
        source = self.folder / "wrong-source"
        shutil.copytree(EXAMPLE, source)
        header = source / "renormalized_upwind.hpp"
        header.write_text(edit(header.read_text(encoding="utf-8"), LAST_CELL), encoding="utf-8")
        wrong = self.build(source, "wrong")
        self.results(self.right, "convergence")
        shutil.copytree(self.folder / "out-right", self.folder / "out-wrong")
        results = self.results(wrong, "convergence", "consistency", code=1)
        verdicts = [series["verdict"] for series in results["convergence"]["series"] if "label" in series]
        self.assertNotIn(verdicts[0], ("confirmed", "pre-asymptotic"))
        self.assertFalse(all(finding["as_expected"] for finding in results["consistency"]["findings"]))

    def test_list_names_it_and_a_plain_acstudy_does_not_know_it(self):
        self.assertIn('model = "renormalized-upwind"  order 1 in max(h,delta)', do(self.right, "list", "schemes"))
        done = subprocess.run([ACSTUDY, "explain", EXAMPLE / "convergence.toml"], text=True, capture_output=True,
                              check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn('model = "renormalized-upwind"; it must be 1 or 2 or "slopes" or "symmetric"', done.stderr)

    def test_a_report_has_it(self):
        self.results(self.right, "convergence", "controls")
        python = sys.executable
        report = self.prefix / "share" / "acstudy" / "reports" / "report.py"
        do(python, report, self.folder / "out-right")
        page = (self.folder / "out-right" / "index.html").read_text(encoding="utf-8")
        self.assertIn("renormalized-upwind", page)
        self.assertNotIn("Model 10", page)

    def test_the_solver_alone_needs_no_gpl_library(self):
        source = self.folder / "alone"
        source.mkdir()
        (source / "main.cpp").write_text(SOLVER_ALONE, encoding="utf-8")
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.20)\nproject(alone LANGUAGES CXX)\n"
            "find_package(acstudy REQUIRED COMPONENTS solver)\nadd_executable(alone main.cpp)\n"
            "target_link_libraries(alone PRIVATE acstudy::solver)\n"
            "if(TARGET acstudy::mms OR TARGET GSL::gsl)\n  message(FATAL_ERROR \"GSL came along\")\nendif()\n",
            encoding="utf-8")
        do("cmake", "-S", source, "-B", source / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        do("cmake", "--build", source / "build", "--verbose")
        self.assertEqual(do(source / "build" / "alone"), "right\n")
        self.assertNotIn("gsl", do("ldd", source / "build" / "alone"))

    def test_what_is_installed_runs_without_the_sources(self):
        self.assertIn("inverse", do(self.prefix / "bin" / "acstudy", "list", "kernels"))
        study = self.prefix / "share" / "acstudy" / "studies" / "fig2.toml"
        self.assertIn("fig2", do(self.prefix / "bin" / "acstudy", "explain", study))


if __name__ == "__main__":
    unittest.main()
