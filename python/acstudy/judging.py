"""Which order errors have, and whether it is theory's."""

from __future__ import annotations

from dataclasses import dataclass
import json
import math
from typing import Any, Iterable, Optional

from acstudy.program import ask


@dataclass(frozen=True)
class Verdict:
    """What the judge says of a table. It is true in a condition, `if judge(...):`, where the order is as asked for."""
    verdict: str               # "confirmed", "pre-asymptotic", "below", ...; docs/verdicts.md explains each
    reason: str                # in a sentence, with the numbers
    ok: bool                   # the order asked for is there; if none was: a sharp one is
    order: float               # in the limit; NaN if there is none
    low: float                 # its 95 % interval
    high: float
    pairwise: list[float]      # between successive levels, coarse to fine
    estimates: dict[str, Any]  # the whole object of `acstudy fit --json`; None stands for what is not finite

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        return f"{self.verdict}: {self.reason}"


def judge(h: Iterable[Any], errors: Iterable[Any], order: Optional[float] = None, *, values: bool = False,
          scale: Optional[float] = None, floor: Optional[float] = None) -> Verdict:
    """Judges errors [n] at spacings h [n], or at any variable that goes to zero with them, in any order of levels.

    order: theory's; 0: the errors must settle; None: whatever order is seen.
    values: `errors` are values of a solution or functional, with no exact one known; `estimates` then has their limit.
    scale: size of the solution; errors below 1e-12 times it are round-off.
    floor: what round-off, quadrature or iteration leaves, in the units of the errors.
    Numbers are judged by the digits that Python prints of them: a table typed by hand has few, a computed one has all.
    InputError if n differs, a variable is not positive, or the table is refused for another reason.
    """
    h, errors = [str(one) for one in h], [str(one) for one in errors]
    if len(h) != len(errors):
        raise ValueError(f"{len(h)} spacings and {len(errors)} errors; give one error for each")
    options = {"--order": order, "--scale": scale, "--floor": floor, "--value": "error" if values else None}
    given = [word for option, value in options.items() if value is not None for word in (option, str(value))]
    table = "".join(f"{one},{error}\n" for one, error in [("h", "error"), *zip(h, errors)])
    code, printed = ask("fit", "-", "--json", *given, given=table, codes=(0, 1))
    found = json.loads(printed)

    def number(value: Optional[float]) -> float:
        return math.nan if value is None else value

    return Verdict(found["verdict"], found["reason"], code == 0, number(found["order"]), number(found["low"]),
                   number(found["high"]), [number(one) for one in found["pairwise"]], found)


def assert_order(h: Iterable[Any], errors: Iterable[Any], order: float, **options: Any) -> Verdict:
    """For tests: the verdict on errors that have theory's order, as `judge` takes them, with its options.

    AssertionError with the verdict and its reason if they have not.
    """
    __tracebackhide__ = True  # pytest shows the caller
    verdict = judge(h, errors, order, **options)
    if not verdict:
        raise AssertionError(f"order {order:g} is not seen: {verdict}")
    return verdict
