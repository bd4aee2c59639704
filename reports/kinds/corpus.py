"""The corpus: synthetic series whose right verdict is known."""

from markupsafe import Markup

from kinds.kind import Kind
from writing import markup, tables

COLUMNS = ("series", "~why", "#theory's order", "right verdict", "given verdict", "right")


def table(study):
    """A row per synthetic series: what is right, and what it got."""
    return tables.table(study.title, COLUMNS, [
        tables.Row((finding.subject, finding.claim, f"{finding.theory_order:g}",
                    " or ".join((finding.expected, *finding.also_expected)), markup.badge(finding),
                    "yes" if finding.as_expected else Markup("<strong>no</strong>")), not finding.as_expected)
        for finding in study.findings])


def _section(study, drawings, entries):
    departing = sum(not entry.as_expected for entry in entries)
    said = Markup('Every series <span class="note">{}: what is right, and what it got</span>').format(len(entries))
    return markup.joined((markup.outcome({"findings": departing}, {"findings": len(entries)}),
                          tables.fold(said, table(study), departing > 0, kind="findings")))


def _held_to(study):
    right = sum(finding.as_expected for finding in study.findings)
    return f"{right} of {markup.several(len(study.findings), 'synthetic series')} of known order get the right verdict."


KIND = Kind(section=_section, held_to=_held_to)
