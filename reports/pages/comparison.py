"""What else computes the same cases, and in how much time: a part of the page."""

from dataclasses import dataclass
import json

from markupsafe import Markup

from writing import markup, tables
from reading.results import ResultError

FILE = "compare/compare.json"   # in the folder of the results
ABSENT = Markup("<p><code>make compare</code> runs the same cases in NumPy, Octave and PySPH and shows here how their run "
                "times compare.</p>\n")


@dataclass(frozen=True)
class Comparison:
    """Tables of run times; they are there only if the errors of all programs agree."""
    command: str
    machine: str
    rounds: int
    cases: int
    tables: tuple       # (title, columns, rows) each, of text
    skipped: tuple      # (program, why)
    wrong: tuple        # a line per error that is not acstudy's


def read(folder):
    """The comparison in `folder`; None without its file."""
    path = folder / FILE
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return Comparison(
            command=_text(found["command"]), machine=_text(found["machine"]), rounds=len(found["rounds"]),
            cases=len(found["cases"]), wrong=tuple(map(_text, found["wrong"])),
            tables=tuple((_text(one["title"]), tuple(map(_text, one["columns"])),
                          tuple(tuple(map(_text, row)) for row in one["rows"])) for one in found["tables"]),
            skipped=tuple((_text(one["label"]), _text(one["missing"])) for one in found["programs"]
                          if one["missing"] is not None))
    except FileNotFoundError:
        return None
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        reason = f"no entry {error}" if isinstance(error, KeyError) else " ".join(str(error).split())
        raise ResultError(f'{path}: {reason}; not a comparison; run "make compare" again or move the file '
                          "away") from error


def _text(found):
    if not isinstance(found, str):
        raise ValueError(f"{found!r} has to be text")
    return found


def section(comparison):
    """The part of the page about a comparison; a line that says where it comes from if there is None."""
    if comparison is None:
        return ABSENT
    found = [tables.table(title, [f"#{column}" if i else f"~{column}" for i, column in enumerate(columns)], rows)
             for title, columns, rows in comparison.tables]
    return markup.render("comparison.html", comparison=comparison, tables=found)
