"""Tables of the page, which its script sorts and filters; entries of the ledger as tables, and the extremes among them."""

from dataclasses import dataclass
import math

from markupsafe import Markup

from reading import ledger, names
from writing import markup


@dataclass(frozen=True)
class Column:
    """kind: "n" for numbers, "said" for text that may be broken into lines, "said why" for what paper leaves out, "mark" for
    a narrow one, else empty."""
    name: str
    kind: str = ""


@dataclass(frozen=True)
class Row:
    """A row; its first cell names it."""
    cells: tuple
    departs: bool = False


@dataclass(frozen=True)
class Table:
    """label: what the table is of, for who does not see it and for the file of its numbers."""
    label: str
    columns: tuple
    rows: tuple

    def __html__(self):
        return markup.render("table.html", table=self)


def table(label, columns, rows):
    """columns: texts, after "#" for numbers, "~" for text that may be broken, "?" for what paper leaves out, "|" for a mark;
    rows: Row or cells."""
    kinds = {"#": "n", "~": "said", "?": "said why", "|": "mark"}
    columns = tuple(Column(Markup(one[1:]) if isinstance(one, Markup) else one[1:], kinds[one[0]]) if one[0] in kinds
                    else Column(one) for one in columns)
    return Table(label, columns, tuple(row if isinstance(row, Row) else Row(tuple(row)) for row in rows))


def fold(summary, content, opened=False, anchor="", kind=""):
    """Content that is shown on demand; `opened`: at once."""
    return markup.render("fold.html", summary=summary, content=content, opened=opened, anchor=anchor, kind=kind)


def worst_observed(statement):
    """The extremes of what was observed where the statement has to hold: orders, and the value nearest its bound."""
    tested = statement.tested or statement.entries
    orders = sorted((entry for entry in tested if math.isfinite(entry.order)), key=lambda entry: entry.order)
    bounded = [entry for entry in tested if not math.isnan(entry.margin)]
    lines = []
    if orders:
        lines.append(_observed("lowest " if len(orders) > 1 else "", orders[0]))
        if len(orders) > 1 and names.order(orders[-1].order) != names.order(orders[0].order):
            lines.append(_observed("highest ", orders[-1]))
    if bounded:
        lines.append(_observed("", min(bounded, key=lambda entry: entry.margin)))
    return markup.joined(lines, markup.BAR) or "–"


def _observed(extreme, entry):
    return Markup("{}{}<br>{}").format(extreme, entry.measured,
                                       markup.note("; ".join(filter(None, (entry.subject, entry.check, worth(entry))))))


def worth(entry):
    """What a wide interval of an order says, and what the verdict rests on; "" for one that says enough."""
    finding = entry.finding
    low, high = finding.observed_low, finding.observed_high
    if not (math.isfinite(low) and math.isfinite(high)) or not entry.as_expected or entry.control:
        return ""
    if high - low < WIDE:
        return ""
    return ("such an interval alone would say little: the verdict rests on " +
            ("the power law of all levels, and the interval does not speak against it" if finding.test == "rate" else
             "the orders of neighboring levels as well"))


WIDE = 0.6      # an interval of an order that is wider tells order 1 neither from 0.7 nor from 1.3


def entry_table(entries, label):
    """A row per entry of the ledger, all of it; of which statement each is, where there are several."""
    several = len({entry.statement for entry in entries}) > 1
    columns = ("subject", "~check", "observed", "verdict", "as expected", "?reason")
    rows = [Row((entry.subject, entry.check, entry.measured, markup.badge(entry, entry.control), _as_expected(entry),
                 Markup("{} {}").format(entry.reason, markup.note(worth(entry))) if worth(entry) else entry.reason)
                + ((entry.statement,) if several else ()), not entry.as_expected) for entry in entries]
    return table(label, columns + (("~statement",) if several else ()), rows)


def folded_entries(entries, label, opened=False):
    """All entries, behind the worst of them if they are many."""
    worst = ledger.Statement(label, tuple(entries)).worst
    said = Markup('Every finding <span class="note">{} in all; the worst: {}, {}: {}, {}</span>').format(
        len(entries), worst.subject, worst.check, worst.measured, worst.verdict)
    return fold(said, entry_table(entries, label), opened, kind="findings")


def _as_expected(entry):
    said = markup.expected(entry)
    role = ("not so as printed" if entry.refuted else "not sharp" if entry.unsharp else
            "negative control" if entry.control else "")
    return Markup("{} {}").format(said, markup.note(role)) if role else said
