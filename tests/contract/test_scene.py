"""acstudy scene: the functions that it prints give the numbers that acstudy computes, whatever the language."""

import importlib.util
import itertools
import json
import math
import shutil
import subprocess
import unittest

from tests.program import ProgramTest

SOURCES = [
    ["--source", "local"],
    *([*"--source nonlocal --delta 0.3".split(), "--model", model, "--kernel", kernel, "--divergence", divergence]
      for (model, kernel), divergence in itertools.product([("1", "inverse"), ("2", "cubic-spline")],
                                                           ["local", "nonlocal"])),
]
# Every smooth function, and those whose derivatives are made of cases.
ZOO = """[scene]
period = "2*pi"
T = "1/2"
c = "2^cos(x) - tanh(sin(x))*exp(-cos(x))"
b = "atan2(sin(x), 3 + cos(x)) - -cos(2*x)^2/4"
u = "log(3 + sin(x - t))*sqrt(2 + cos(x)) + asin(sin(x)/2)*acos(cos(x)/3) + (2 + cos(x))^3*cosh(t) - sinh(t*sin(x)) + \
tan(sin(x)/3)/(2 + atan(cos(x))) + (2 + sin(x))^sin(t)"
"""
ROUGH = """[scene]
period = "2*pi"
T = 1
c = "max(sin(x), cos(x)) - abs(sin(x))/3"
b = "min(sin(x), 0.3)/4"
u = "max(cos(x - t), abs(sin(x)))"
"""
STANDING = """[scene]
period = "1"
T = 1
c = "-1"
u = "sin(2*pi*(x + t))^2"
"""
GIVEN = """[scene]
period = "2*pi"
T = 1
c = "1 + cos(x)/2"
reference = "finest"
u0 = "exp(cos(x))"
f = "sin(x - t)"
"""
POINTS = [0.1 + 0.37 * i for i in range(40)]
TIME = 0.4

C_MAIN = """
#include <stdio.h>
int main(void) {
  double x;
  while (scanf("%lf", &x) == 1) printf("%.17g %.17g %.17g\\n", scene_c(x), scene_u(x, TIME), scene_f(x, TIME));
}
"""
FORTRAN_MAIN = """
program main
  use scene
  implicit none
  integer :: status
  double precision :: x
  do
    read (*, *, iostat=status) x
    if (status /= 0) exit
    print '(3es26.17e3)', c(x), u(x, TIME), f(x, TIME)
  end do
end program main
"""
JULIA_MAIN = """
for line in eachline()
    x = parse(Float64, line)
    println(Scene.c(x), " ", Scene.u(x, TIME), " ", Scene.f(x, TIME))
end
"""


class SceneTest(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, text in (("zoo", ZOO), ("rough", ROUGH), ("standing", STANDING), ("given", GIVEN)):
            (self.folder / f"{name}.toml").write_text(text, encoding="utf-8")
        (self.folder / "x.csv").write_text("x\n" + "".join(f"{x}\n" for x in POINTS), encoding="utf-8")

    def printed(self, *args):
        done = self.acstudy("scene", *args)
        self.assertEqual((done.returncode, done.stderr), (0, ""), args)
        return done.stdout

    def expected(self, scene, source):
        """c, u and f at the points, as acstudy computes them."""
        header, *rows = self.printed(scene, *source, "--time", str(TIME), "--at", "x.csv").splitlines()
        columns = dict(zip(header.split(","), zip(*(map(float, row.split(",")) for row in rows))))
        self.assertEqual(list(columns["x"]), POINTS)
        return columns["c"], columns["u"], columns["f"]

    def compare(self, language, evaluate, sources=None):
        smooth = itertools.product(("lee-du-2019", "zoo.toml", "standing.toml"), sources or SOURCES)
        for scene, source in [*smooth, ("rough.toml", SOURCES[0])]:
            with self.subTest(scene=scene, source=source):
                code = self.printed(scene, *source, "--language", language)
                for got, wanted in zip(evaluate(code), self.expected(scene, source), strict=True):
                    scale = max(map(abs, wanted))
                    self.assertLessEqual(max(abs(a - b) for a, b in zip(got, wanted, strict=True)), 1e-13 * scale)

    def run_on_points(self, *command):
        done = subprocess.run(command, input="".join(f"{x}\n" for x in POINTS), capture_output=True, text=True,
                              cwd=self.folder, check=True)
        return zip(*(map(float, line.split()) for line in done.stdout.splitlines()))

    def test_python(self):
        import numpy as np

        def evaluate(code):
            file = self.folder / "scene_code.py"
            file.write_text(code, encoding="utf-8")
            spec = importlib.util.spec_from_file_location("scene_code", file)
            scene = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(scene)
            x = np.array(POINTS)
            return scene.c(x), scene.u(x, TIME), scene.f(x, TIME)

        self.compare("python", evaluate)

    def test_c(self):
        def evaluate(code):
            (self.folder / "scene.c").write_text(code + C_MAIN.replace("TIME", str(TIME)), encoding="utf-8")
            subprocess.run("cc -std=c99 -Wall -Wextra -Wno-unused-parameter -Werror scene.c -o scene -lm".split(), cwd=self.folder, check=True)
            return self.run_on_points("./scene")

        self.compare("c", evaluate)

    @unittest.skipUnless(shutil.which("gfortran"), "there is no gfortran")
    def test_fortran(self):
        def evaluate(code):
            main = FORTRAN_MAIN.replace("TIME", f"{TIME}d0")
            (self.folder / "scene.f90").write_text(code + main, encoding="utf-8")
            subprocess.run("gfortran -std=f2008 -Wall -Wno-unused-dummy-argument -Werror scene.f90 -o scene".split(),
                           cwd=self.folder, check=True)
            return self.run_on_points("./scene")

        self.compare("fortran", evaluate)

    @unittest.skipUnless(shutil.which("julia"), "there is no julia")
    def test_julia(self):
        def evaluate(code):
            (self.folder / "scene.jl").write_text(code + JULIA_MAIN.replace("TIME", str(TIME)), encoding="utf-8")
            return self.run_on_points("julia", "scene.jl")

        self.compare("julia", evaluate, SOURCES[:3])

    def test_json_says_the_same_as_data(self):
        def evaluate(code):
            scene = json.loads(code)
            self.assertEqual(scene["format"], "acstudy-scene-1")
            names = {"abs": abs, "min": min, "max": max, "choose": lambda p, a, b: a if p else b, **scene["constants"],
                     **{name: getattr(math, name) for name in
                        "sin cos tan asin acos atan sinh cosh tanh exp log sqrt atan2".split()}}

            def value(text, local):
                return eval(text.replace("^", "**").replace("if(", "choose(").replace(" <= ", "<=", 1), names, local)

            def do(statements, local):
                for one in statements:
                    if "set" in one:
                        local[one["set"]] = value(one["value"], local)
                    else:
                        local[one["add_to"]] += value(one["value"], local)

            def define(body):
                def function(*arguments):
                    local = dict(zip(body["arguments"], arguments))
                    do(body["first"], local)
                    for one in body.get("sums", []):
                        rule = scene["rules"][one["over"]]
                        for local["node"], local["weight"] in zip(rule["node"], rule["weight"]):
                            do(one["each"], local)
                    return value(body["value"], local)
                return function

            for name, body in scene["functions"].items():
                names[name] = define(body)
            return ([names["c"](x) for x in POINTS], [names["u"](x, TIME) for x in POINTS],
                    [names["f"](x, TIME) for x in POINTS])

        self.compare("json", evaluate)

    def test_the_tolerance_tells_apart_sources_that_differ(self):
        local, nonlocal_ = (self.expected("lee-du-2019", source)[2] for source in (SOURCES[0], SOURCES[1]))
        self.assertGreater(max(abs(a - b) for a, b in zip(local, nonlocal_)), 1e-3)

    def test_a_given_source_is_printed_where_no_solution_is_known(self):
        code = self.printed("given.toml", "--language", "python")
        self.assertIn("def u0(x)", code)
        self.assertNotIn("def u(", code)
        names = {}
        exec(code, names)
        self.assertAlmostEqual(float(names["f"](1.0, 0.25)), math.sin(0.75), places=14)

    def test_kernels_with_parameters_are_written_as_in_studies(self):
        code = self.printed("lee-du-2019", "--source", "nonlocal", "--model", "2", "--divergence", "local", "--delta",
                            "0.1", "--kernel", '{ name = "power", alpha = 0.5 }', "--language", "c")
        self.assertIn("power(0.5)", code)
        self.assertIn("scene_mu", code)

    def test_mistakes_are_said(self):
        nonlocal_ = ["--source", "nonlocal", "--language", "c"]
        for args, message in (
                (["lee-du-2019"], "write --language python, or --at"),
                (["lee-du", "--language", "c"], 'unknown scene "lee-du"'),
                (["no.toml", "--language", "c"], "no.toml: cannot be read"),
                (["lee-du-2019", "--language", "pascal"], '"pascal" is none of python'),
                (["lee-du-2019", *nonlocal_], "needs a horizon"),
                (["lee-du-2019", *nonlocal_, "--delta", "4"], "below half the period"),
                (["lee-du-2019", *nonlocal_, "--delta", "0.1"], "model"),
                (["lee-du-2019", *nonlocal_, "--delta", "0.1", "--model", "3"], "model = 3"),
                (["lee-du-2019", *nonlocal_, "--delta", "0.1", "--model", "2", "--divergence", "local", "--kernel",
                  "inverse"], "needs an integrable kernel"),
                (["given.toml", *nonlocal_, "--delta", "0.1"], "no exact solution"),
                (["lee-du-2019", "--at", "x.csv"], "--time"),
                (["lee-du-2019", "--time", "1", "--at", "none.csv"], "none.csv")):
            with self.subTest(args=args):
                done = self.acstudy("scene", *args)
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertIn(message, done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
