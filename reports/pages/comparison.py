"""What else computes the same cases, and in how much time: a part of the page."""

from dataclasses import dataclass
from html import escape
import json

from writing import markup
from reading.results import ResultError

FILE = "compare/compare.json"   # in the folder of the results
ABSENT = ("<p><code>make compare</code> runs the same cases in NumPy, Octave and PySPH and shows here how their run "
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
    heading = '<section aria-labelledby="comparison">\n<h2 id="comparison">Other programs on the same cases</h2>\n'
    if comparison is None:
        return f"{heading}{ABSENT}</section>\n"
    if comparison.wrong:
        lines = "".join(f"<li>{escape(line)}</li>" for line in comparison.wrong)
        said = (f'<p class="outcome bad">{len(comparison.wrong)} errors are not those of acstudy, so that run times '
                f"mean nothing.</p>\n<ul>{lines}</ul>\n")
    else:
        said = (f'<p class="outcome good">All programs have the same errors, to 1e-9, in those of '
                f"{comparison.cases} cases that they run.</p>\n"
                "<p>Run times as multiples of those of acstudy on one thread: the median over the rounds of the ratio "
                "within a round and, in brackets, the smallest and the largest. Cases that acstudy runs on the same "
                "particles share their time.</p>\n")
        said += "".join(_table(*table) for table in comparison.tables)
    skipped = "".join(f"<li>{escape(label)}: {escape(why)}</li>" for label, why in comparison.skipped)
    skipped = f"<p>Skipped:</p>\n<ul>{skipped}</ul>\n" if skipped else ""
    origin = (f'<p class="note">{comparison.rounds} rounds, one program after the other, on '
              f"{escape(comparison.machine)}: <code>{escape(comparison.command)}</code></p>\n")
    return f"{heading}{said}{skipped}{origin}</section>\n"


def _table(title, columns, rows):
    body = "".join(f'<tr><th scope="row">{escape(row[0])}</th>'
                   + "".join(f'<td class="number">{escape(cell)}</td>' for cell in row[1:]) + "</tr>\n" for row in rows)
    return markup.table([escape(column) for column in columns], body, title, numbers=True)
