"""The program acstudy: where it is, and how it is asked."""

from __future__ import annotations

import os
from pathlib import Path
import shutil
import subprocess
from typing import Optional
import warnings


class Error(RuntimeError):
    """The program failed, with its message; `code` is its exit code, or minus the signal that ended it."""

    def __init__(self, message: str, code: int):
        super().__init__(message)
        self.code = code


class InputError(Error, ValueError):
    """What was given is wrong: nothing was computed or written."""


def program() -> str:
    """The path of the program: in this package, or named by the environment variable ACSTUDY, or found on the PATH.

    FileNotFoundError if there is none.
    """
    packaged = Path(__file__).with_name("bin") / "acstudy"
    named = os.environ.get("ACSTUDY")
    found = str(packaged) if packaged.exists() else shutil.which(named or "acstudy")
    if found is None:
        raise FileNotFoundError(
            f"ACSTUDY = {named}; there is no such program" if named else
            "there is no program acstudy in the package or on the PATH; install with pip, or set ACSTUDY to its path")
    return os.path.abspath(found)


def ask(*arguments: object, given: str = "", folder: Optional[str] = None,
        codes: tuple[int, ...] = (0,)) -> tuple[int, str]:
    """Exit code and output of the program, run in a folder, the current one by default, with `given` as its input.

    InputError or Error if the exit code is none of `codes`.
    """
    done = subprocess.run([program(), *map(str, arguments)], input=given, cwd=folder, capture_output=True,
                          encoding="utf-8", check=False)
    said = done.stderr.strip().removeprefix("acstudy: ")
    if done.returncode not in codes:
        said = said or f"acstudy {arguments[0]} ended with {done.returncode}"
        raise (InputError if done.returncode == 2 else Error)(said, done.returncode)
    if said:
        warnings.warn(said, stacklevel=3)
    return done.returncode, done.stdout
