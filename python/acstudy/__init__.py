"""Convergence studies from Python: judge errors of any solver, take manufactured problems, run studies, read results.

    import acstudy
    print(acstudy.judge(h, errors, order=2))
    acstudy.assert_order(h, errors, 2)
    f = acstudy.Scene("lee-du-2019").source(x, t)
    table = acstudy.run("study.toml", out="out")

All of it is done by the program acstudy, which a package that pip has installed brings along; a source tree finds it by
the environment variable ACSTUDY or on the PATH. What the program refuses is an InputError, what fails an Error, both
with its message. What it warns of on the way is a Python warning.
"""

from acstudy.judging import Verdict, assert_order, judge
from acstudy.program import Error, InputError, program
from acstudy.scenes import Scene
from acstudy.studies import results, run

__all__ = ["Error", "InputError", "Scene", "Verdict", "assert_order", "judge", "program", "results", "run"]
