"""The built program, run on study files in a temporary folder."""

import json
import os
from pathlib import Path
import subprocess
import tempfile
import unittest
import zlib

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
ACSTUDY = Path(os.environ.get("ACSTUDY", ROOT / "build" / "acstudy")).resolve()

# Speeds that `acstudy explain` finds are kept for the tests of this process alone.
CACHE = tempfile.TemporaryDirectory(prefix="acstudy-cache-")
os.environ["XDG_CACHE_HOME"] = CACHE.name

STUDY = """\
[study]
name = "tiny"
title = "A tiny study"

[scene]
use = "lee-du-2019"

[[scheme]]
model = 1
divergence = "local"
kernel = "inverse"

[time]
integrator = "forward-euler"
step = "h/4"

[[path]]
name = "delta = 4h"
delta = "4*h"
N = [16, 32, 64]
source = "local"
"""

USE = 'use = "lee-du-2019"'
FIELDS = """\
period = "2*pi"
T = 1
c = "cos(2*x)/3"
b = "sin(x)"
u = "cos(x-t)"
flow = "2*atan2(sin(x/2)*exp(t), cos(x/2))\""""

MODEL_II = ('model = 1\ndivergence = "local"\nkernel = "inverse"',
            'model = 2\ndivergence = "local"\nkernel = "cubic-spline"')


def edit(text, *changes):
    """The text with each (old, new) replaced; every old must stand there exactly once."""
    for old, new in changes:
        if text.count(old) != 1:
            raise ValueError(f"{old!r} stands {text.count(old)} times in\n{text}")
        text = text.replace(old, new)
    return text


INLINE = edit(STUDY, (USE, FIELDS))
# The same where no solution is known: errors are against the finest run.
UNSOLVED = edit(INLINE, ('u = "cos(x-t)"', 'reference = "finest"\nu0 = "cos(x)"\nf = "sin(x-t)"'))

LEVELS = "[16, 32, 64]"
SCENE = '"lee-du-2019"'
# Particles at rest in the flow of a smooth solution: first order from the coarsest level on.
GOOD = edit(STUDY, (SCENE, '"lagrangian"'), (LEVELS, "[32, 64, 128, 256]"))
# Both models, both divergences, all kernels, both sources, horizons above, at and below the spacing.
WIDE = STUDY[:STUDY.index("[[scheme]]")] + """\
[[scheme]]
model = 1
divergence = "local"
kernel = "inverse"

[[scheme]]
model = 1
divergence = "nonlocal"
kernel = { name = "power", alpha = 0.5 }

[[scheme]]
model = 2
divergence = "nonlocal"
kernel = "cubic-spline"
mu = 1.5

[time]
integrator = "ssprk2"
step = "h/4"

[[path]]
name = "delta = 4h"
delta = "4*h"
N = [16, 32, 64]
source = "local"

[[path]]
name = "delta = h^2"
delta = "h^2"
N = [16, 32]
source = "local"

[[path]]
name = "delta = 1"
delta = 1
N = [16, 32]
source = "nonlocal"
"""
CASES_OF_WIDE = 3 * (3 + 2 + 2)


def strict_json(text, **options):
    """JSON as a strict parser reads it; Python's own takes NaN and Infinity, too."""
    def refuse(name):
        raise ValueError(f"{name} is not JSON")

    return json.loads(text, parse_constant=refuse, **options)


def series_of(file):
    return [file["series"][name] for name in sorted(file["series"])]


def text_of(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else attribute


def numbers(path):
    """Everything in a result file but how long it took and where it was made, as bytes by name."""
    content = {}

    def visit(name, item):
        if name.startswith("provenance"):
            return
        for key, value in item.attrs.items():
            content[f"{name}@{key}"] = np.asarray(value).tobytes()
        if isinstance(item, h5py.Dataset) and "seconds" not in name and not name.endswith("repeats"):
            content[name] = item[()].tobytes()

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return content


def reseal(path):
    """Makes a result file that h5py has changed one that the program takes for its own."""
    content = path.read_bytes()
    words = f"acstudy: crc32 {zlib.crc32(content[512:]):08x} of the {len(content) - 512} bytes after these 512\n"
    path.write_bytes(words.encode().ljust(512, b"\0") + content[512:])


def install(prefix):
    """Installs the build that the program stands in; False where it stands in none."""
    if not (ACSTUDY.parent / "cmake_install.cmake").exists():
        return False
    subprocess.run(["cmake", "--install", ACSTUDY.parent, "--prefix", prefix], check=True, capture_output=True)
    return True


class ProgramTest(unittest.TestCase):
    maxDiff = None
    program = ACSTUDY

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        path = Path(self.folder, name)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def acstudy(self, *arguments, **options):
        """Runs the program in the temporary folder."""
        return subprocess.run([self.program, *map(str, arguments)], cwd=self.folder, text=True, capture_output=True,
                              check=False, timeout=60, **options)

    def run_study(self, text, *arguments, out="out", expect=None, **options):
        """Writes tiny.toml and runs it into `out`; `expect`: the exit code, any by default."""
        self.write("tiny.toml", text)
        done = self.acstudy("run", "tiny.toml", "--out", out, *arguments, **options)
        if expect is not None:
            self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def result(self, study="tiny", out="out", **options):
        return strict_json((self.folder / out / f"{study}.json").read_text(encoding="utf-8"), **options)

    def assert_counts(self, done, computed, stored):
        self.assertIn(f"{computed} cases computed, {stored} taken from the store;", done.stdout, done.stderr)

    def assert_bad_input(self, done, message):
        """Exit code 2, this one line, and nothing else."""
        self.assertEqual((done.returncode, done.stdout, done.stderr), (2, "", f"acstudy: {message}\n"))

    def fit(self, table, *arguments):
        self.write("table.csv", table)
        return self.acstudy("fit", "table.csv", *arguments)

    def fitted(self, table, *arguments, code):
        """What `acstudy fit --json` says of a table, with this exit code."""
        done = self.fit(table, "--json", *arguments)
        self.assertEqual((done.returncode, done.stderr), (code, ""), done.stdout)
        return strict_json(done.stdout)
