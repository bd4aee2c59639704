"""What a report has to know of a kind of study, and what it shows where a kind says nothing else."""

from dataclasses import dataclass
from typing import Callable

from writing import figures, markup
from writing.tables import entry_table, folded_entries


def section(study, drawings, entries, above="", below="", every=None):
    """Figures and all findings; those that depart are not folded away. `above`, `below`: the figures; `every`: in place
    of the table of all."""
    departing = [entry for entry in entries if not entry.as_expected]
    parts = [markup.outcome({"findings": len(departing)}, {"findings": len(entries)}), above]
    parts += figures.shown(drawings)
    if departing:
        parts.append(entry_table(departing, f"{study.title}: not as expected"))
    parts.append(below)
    if every is not None:
        parts.append(every)
    elif entries:
        parts.append(folded_entries(entries, study.title))
    return markup.joined(parts)


@dataclass(frozen=True)
class Kind:
    """How the studies of a kind are shown."""
    drawings: Callable = lambda study, styles: []   # its figures in the order of its section
    section: Callable = section         # (study, drawings, entries) -> Markup between heading and origin
    disputes: bool = False              # where it expects another verdict than promised, it disputes the statement
    held_to: Callable = None            # (study) -> a sentence; it examines the measurement itself, and is no evidence
    run_times: bool = False             # its schemes keep their looks in all figures, and their run times are compared
    noun: str = "findings"              # what its findings are called
