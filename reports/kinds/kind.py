"""What a report has to know of a kind of study, and what it shows where a kind says nothing else."""

from dataclasses import dataclass
from html import escape
from typing import Callable

from writing import markup
from writing.tables import entry_table


@dataclass(frozen=True)
class Summary:
    """A table of the first page, with rows of every study of some kinds."""
    noun: str           # what is counted in the first sentence of the page
    introduction: str   # HTML above the table
    columns: tuple
    label: str
    rows: Callable      # (study) -> HTML


def departing_text(study):
    departing = sum(not finding.as_expected for finding in study.findings)
    return f"<strong>{departing} not</strong>" if departing else "all"


def row_head(study):
    """The beginning of a row about a study as a whole."""
    departing = any(not finding.as_expected for finding in study.findings)
    return (f'<tr{markup.departs_if(departing)}>'
            f'<td><a href="#{study.name}">{study.name}</a></td><th scope="row">{escape(study.title)}</th>')


def _findings_row(study):
    statements = ", ".join(dict.fromkeys(finding.statement for finding in study.findings))
    return (f'{row_head(study)}<td class="said">{escape(statements)}</td>'
            f'<td class="number">{len(study.findings)}</td>'
            f'<td class="number">{sum(finding.control for finding in study.findings)}</td>'
            f"<td>{departing_text(study)}</td></tr>\n")


BY_FINDINGS = Summary("findings", "<p>Judged by findings:</p>\n",
                      ("study", "", "statements", "findings", "negative controls", "as expected"),
                      "Studies judged by findings", _findings_row)


def section(study, drawings, entries, above="", below="", every=None):
    """Figures and all findings; those that depart are not folded away. `above`, `below`: the figures; `every`: in place
    of the table of all."""
    departing = [entry for entry in entries if not entry.as_expected]
    parts = [markup.outcome({"findings": len(departing)}, {"findings": len(entries)}), above]
    parts += [markup.figure(drawing) for drawing in drawings]
    if departing:
        parts.append(entry_table(departing, f"{study.title}: not as expected"))
    parts.append(below)
    if every is not None:
        parts.append(every)
    elif entries:
        parts.append(f"<details><summary>Every finding</summary>\n{entry_table(entries, study.title)}</details>\n")
    return "".join(parts)


@dataclass(frozen=True)
class Kind:
    """How the studies of a kind are shown."""
    drawings: Callable = lambda study, styles: []   # its figures in the order of its section
    section: Callable = section         # (study, drawings, entries) -> HTML between heading and provenance
    summary: Summary = BY_FINDINGS
    disputes: bool = False              # where it expects another verdict than promised, it disputes the statement
    held_to: Callable = None            # (study) -> a sentence; it examines the measurement itself, and is no evidence
    run_times: bool = False             # its schemes keep their looks in all figures, and their run times are compared
