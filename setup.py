"""The package that pyproject.toml describes, with the program: built by CMake, or named by ACSTUDY_PROGRAM."""

import os
from pathlib import Path
import re
import shlex
import shutil
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py
try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # before setuptools 70.1
    from wheel.bdist_wheel import bdist_wheel

ROOT = Path(__file__).resolve().parent
FOLDER = "build-wheel"  # of setuptools, which would else write among what make builds


def built_program():
    """The path of the program, built unless it is there."""
    if named := os.environ.get("ACSTUDY_PROGRAM"):
        return Path(named)
    folder = ROOT / FOLDER / "cmake"
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DACSTUDY_TESTS=OFF",
                    "-DACSTUDY_FOLDERS=ON", *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "acstudy"], check=True,
                   env={"CMAKE_BUILD_PARALLEL_LEVEL": str(os.cpu_count()), **os.environ})
    return folder / "acstudy"


class WithProgram(build_py):
    def run(self):
        super().run()
        if not self.editable_mode:  # a source tree finds the program by ACSTUDY or on the PATH
            place = Path(self.build_lib, "acstudy", "bin")
            place.mkdir(exist_ok=True)
            shutil.copy(built_program(), place / "acstudy")


class ForThisMachine(bdist_wheel):
    """The wheel is for any Python 3, but only for this kind of machine."""

    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setup(version=re.search(r"VERSION ([\d.]+)\n", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1],
      cmdclass={"build_py": WithProgram, "bdist_wheel": ForThisMachine},
      options={"build": {"build_base": FOLDER}, "egg_info": {"egg_base": "python"}})
