"""Claim by claim: what each statement of theory says, and what was measured of it."""

from markupsafe import Markup

from kinds import registry
from reading import ledger
from writing import markup, tables

COLUMNS = ("~statement", "~what it says", "~measured on", "~worst observed", "verdict", "as expected", "~where")
ABOUT = Markup("""<p>The verdict of a statement is that of the worst that was measured of it. One that is <em>not so as
printed</em> is expected to fail somewhere; a remark with its findings says why and what holds instead. A negative
control is a case in which the statement must fail, because one of its assumptions does, or in which an error must
settle: it shows that the measurement would see a failure, and counts as no evidence.</p>
""")


def statements(studies):
    """(statements of the paper, further statements); what examines the measurement itself is no evidence for either."""
    return ledger.statements(entry for study in studies if not registry.of(study).held_to
                             for entry in registry.entries(study))


def table(statements, drawings, label):
    """A row per statement. `drawings`: {name of a study: its drawings}."""
    return markup.joined((ABOUT, tables.table(label, COLUMNS, [_row(one, drawings) for one in statements])))


def _row(statement, drawings):
    worst = statement.worst
    verdict = markup.badge(worst, worst.control)
    if statement.refuted and not statement.departing:
        verdict = markup.tag("not so as printed", "near")
    said = "all"
    if statement.departing:
        said = Markup("<strong>{} of {} not</strong>").format(len(statement.departing), len(statement.entries))
    return tables.Row((statement.name, markup.joined(statement.claims, markup.BAR), _measured(statement),
                       tables.worst_observed(statement), verdict, said, _where(statement, drawings)),
                      bool(statement.departing))


def _measured(statement):
    """On how much, and what of it is no plain evidence; with the remarks of its findings."""
    subjects = len({entry.subject for entry in statement.tested})
    checks = len({entry.check for entry in statement.tested})
    lines = [", ".join((markup.several(len(statement.tested), "finding"), markup.several(subjects, "subject"),
                        markup.several(checks, "condition")))] if statement.tested else []
    if statement.controls:
        caught = sum(entry.as_expected for entry in statement.controls)
        lines.append(markup.note(f"negative controls: {caught} of {len(statement.controls)} fail or settle as they must"))
    if statement.unsharp:
        lines.append(markup.note(f"{markup.several(len(statement.unsharp), 'finding')} more: a bound is not attained"))
    if statement.refuted and not statement.departing:
        lines.append(markup.note(f"{len(statement.refuted)} of {len(statement.tested)} show that it does not hold as "
                                 "printed"))
    remarks = dict.fromkeys(entry.remark for entry in statement.entries if entry.remark)
    if remarks:
        lines.append(tables.fold(markup.several(len(remarks), "remark"),
                                 markup.joined(Markup("<p>{}</p>").format(remark) for remark in remarks)))
    return markup.joined(lines, markup.BAR)


def _where(statement, drawings):
    """Links to the studies that measured it, whose tables the script shows of this statement alone, and to figures."""
    lines = []
    for study in dict.fromkeys(entry.study.name for entry in statement.entries):
        of_study = drawings.get(study, [])
        shown = [one for one in of_study if statement.name in one.statements]
        count = sum(entry.study.name == study for entry in statement.entries)
        links = [Markup('<a href="#{}" data-find="{}">{}</a>').format(
            study, statement.name, f"{study}: {markup.several(count, 'finding')}")]
        links += [markup.link(f"{one.stem}.figure", "figure")
                  for one in shown or [one for one in of_study if not one.statements][:1]]
        lines.append(markup.joined(links, ", "))
    return markup.joined(lines, markup.BAR)
