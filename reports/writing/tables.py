"""Entries of the ledger as tables: all of them, and the extremes of what was observed."""

from html import escape
import math

from reading import names
from writing import markup

DETAILS = ("subject", "check", "observed", "verdict", "as expected", "reason")


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
    return "<br>".join(lines) or "–"


def _observed(extreme, entry):
    return (f"{extreme}{escape(entry.measured)}<br>"
            f'<span class="note">{escape(entry.subject)}; {escape(entry.check)}</span>')


def entry_table(entries, label):
    """A row per entry of the ledger, all of it."""
    rows = "".join(
        f'<tr{markup.departs(entry)}><th scope="row">{escape(entry.subject)}</th><td>{escape(entry.check)}</td>'
        f"<td>{escape(entry.measured)}</td><td>{markup.badge(entry, entry.control)}</td>"
        f'<td>{_as_expected(entry)}</td><td class="said">{escape(entry.reason)}</td></tr>\n' for entry in entries)
    return markup.table(DETAILS, rows, label)


def _as_expected(entry):
    said = markup.expected(entry)
    role = ("not so as printed" if entry.refuted else "not sharp" if entry.unsharp else
            "negative control" if entry.control else "")
    return f'{said} <span class="note">{role}</span>' if role else said
