"""Mistakes that were seeded in the sources to test the tests: what scripts/mutants.py found, as a part of the page."""

from dataclasses import dataclass
import json

from markupsafe import Markup

from writing import markup, tables
from reading.results import ResultError

FILE = "mutants/mutants.json"   # in the folder of the results
COLUMNS = ("~mistake", "~what it is", "~file", "outcome", "~caught by", "as expected")
ABSENT = Markup("<p><code>make mutants</code> plants mistakes in a copy of the sources and shows here what sees them.</p>\n")


@dataclass(frozen=True)
class Mutant:
    """One patch of the sources, and what came of it."""
    name: str
    file: str
    what: str
    expected: str       # "caught" | "survives"
    outcome: str        # "caught" | "survives" | "error": the patch does not apply or does not compile
    as_expected: bool
    caught_by: tuple    # (kind, name), kind: "test" | "gate"
    error: str          # of a patch that does not apply or compile; else empty

    @property
    def control(self):
        """Whether the patch changes nothing that counts, and has to survive."""
        return self.expected == "survives"


def read(folder):
    """The mutants whose outcome is known in `folder`, in the order of the file; None without a file."""
    path = folder / FILE
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return tuple(map(_mutant, found["mutants"]))
    except FileNotFoundError:
        return None
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        reason = f"no entry {error}" if isinstance(error, KeyError) else " ".join(str(error).split())
        raise ResultError(f'{path}: {reason}; not a table of mutants; run "make mutants" again or move the file '
                          "away") from error


def _mutant(found):
    texts = {name: found[name] for name in ("name", "file", "what", "expected", "outcome")}
    for name, text in (*texts.items(), ("error", found.get("error", ""))):
        if not isinstance(text, str):
            raise ValueError(f"{name} = {text!r}, but it has to be text")
    if not isinstance(found["as_expected"], bool):
        raise ValueError(f"as_expected = {found['as_expected']!r}, but it has to be true or false")
    return Mutant(**texts, as_expected=found["as_expected"], error=found.get("error", ""),
                  caught_by=tuple((str(one["kind"]), str(one["name"])) for one in found["caught_by"]))


def section(mutants):
    """The part of the page about `mutants`; a line that says where they come from if there are None."""
    if mutants is None:
        return ABSENT
    mistakes = [mutant for mutant in mutants if not mutant.control]
    caught = sum(mutant.as_expected for mutant in mistakes)
    kind = "good" if all(mutant.as_expected for mutant in mutants) else "bad"
    said = f"{caught} of {len(mistakes)} seeded mistakes are caught by a test or a gate"
    controls = [mutant for mutant in mutants if mutant.control]
    if controls:
        survive = sum(mutant.as_expected for mutant in controls)
        said += f"; {survive} of {len(controls)} harmless changes survive, as they must"
    rows = [_row(mutant) for mutant in sorted(mutants, key=lambda mutant: mutant.as_expected)]
    return markup.render("mutants.html", kind=kind, said=said, table=tables.table("Seeded mistakes", COLUMNS, rows))


def _row(mutant):
    badge = "bad" if not mutant.as_expected else "control" if mutant.control else "good"
    name = (Markup("{} {}").format(mutant.name, markup.note("control: must survive")) if mutant.control else
            mutant.name)
    return tables.Row((name, mutant.what, mutant.file, markup.tag(mutant.outcome, badge), _caught_by(mutant),
                       markup.expected(mutant)), not mutant.as_expected)


def _caught_by(mutant):
    if mutant.error:
        return tables.fold("output", Markup("<pre>{}</pre>").format(mutant.error), opened=True)
    if not mutant.caught_by:
        return "nothing"
    kinds = [kind for kind, _ in mutant.caught_by]
    counts = ", ".join(markup.several(kinds.count(kind), kind) for kind in dict.fromkeys(kinds))
    return tables.fold(counts, Markup("<ul>{}</ul>").format(markup.joined(
        Markup("<li>{}: {}</li>").format(kind, name) for kind, name in mutant.caught_by)))
