"""The corpus: synthetic series whose right verdict is known."""

from html import escape

from kinds.kind import Kind
from writing import markup


def table(study):
    """A row per synthetic series: what is right, and what it got."""
    rows = "".join(
        f'<tr{markup.departs(finding)}><th scope="row">{escape(finding.subject)}</th>'
        f'<td class="said">{escape(finding.claim)}</td><td class="number">{finding.theory_order:g}</td>'
        f"<td>{escape(' or '.join((finding.expected, *finding.also_expected)))}</td>"
        f"<td>{markup.badge(finding)}</td><td>{'yes' if finding.as_expected else '<strong>no</strong>'}</td></tr>\n"
        for finding in study.findings)
    columns = ("series", "why", "theory's order", "right verdict", "given verdict", "right")
    return markup.table(columns, rows, study.title)


def _section(study, drawings, entries):
    departing = sum(not entry.as_expected for entry in entries)
    return markup.outcome({"findings": departing}, {"findings": len(entries)}) + table(study)


def _held_to(study):
    right = sum(finding.as_expected for finding in study.findings)
    return f"{right} of {markup.several(len(study.findings), 'synthetic series')} of known order get the right verdict."


KIND = Kind(section=_section, held_to=_held_to)
