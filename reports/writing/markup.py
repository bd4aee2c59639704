"""Parts of the pages of a report, as HTML without scripts that reads nothing from a network."""

from html import escape
import math
from pathlib import Path
from urllib.parse import quote

STYLE = (Path(__file__).parent / "page.css").read_text(encoding="utf-8")

# How a verdict is to be read; its badge also carries its name, so that color is never the only sign.
KINDS = {"confirmed": "good", "holds": "good", "pre-asymptotic": "near", "floor": "fair", "inconclusive": "fair"}


def document(title, introduction, links, body):
    """A page as text. `links`: (address, name) of its navigation."""
    navigation = "".join(f'<a href="{escape(address)}">{escape(name)}</a>' for address, name in links)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{escape(title)}</title>
<style>
{STYLE}</style>
</head>
<body>
<header>
<h1>{escape(title)}</h1>
<p>{introduction}</p>
<nav aria-label="Pages and parts">{navigation}</nav>
</header>
<main>
{body}</main>
</body>
</html>
"""


def figure(drawing):
    """A drawing.Drawing with its caption and its files."""
    stem = quote(drawing.stem)
    return (f'<figure id="{escape(drawing.stem)}.figure">\n'
            f'<div class="card" tabindex="0"><img src="{stem}.svg" alt="{escape(drawing.alt)}"></div>\n'
            f'<figcaption>{escape(drawing.caption)} <a href="{stem}.svg">SVG</a></figcaption>\n</figure>\n')


def table(columns, rows, label, numbers=False):
    kind = ' class="number"' if numbers else ""
    heads = "".join(f'<th scope="col"{kind}>{column}</th>' for column in columns)
    return (f'<div class="scroll" role="region" tabindex="0" aria-label="{escape(label)}">\n<table>\n'
            f"<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>\n</div>\n")


def listing(entries):
    return ("<dl>\n" + "".join(f"<dt>{escape(key)}</dt><dd>{escape(value)}</dd>\n" for key, value in entries.items())
            + "</dl>\n")


def outcome(departing, what):
    """The first sentence of a page: `departing` and `what` are {noun: number}."""
    total = " and ".join(f"{number} {noun}" for noun, number in what.items() if number)
    if not total:
        return '<p class="outcome good">No series has been run.</p>\n'
    if any(departing.values()):
        said = " and ".join(f"{departing[noun]} of {number} {noun}" for noun, number in what.items() if number)
        return f'<p class="outcome bad">{said} not as expected.</p>\n'
    return f'<p class="outcome good">All {total} are as expected.</p>\n'


def departs(result):
    return departs_if(not result.as_expected)


def departs_if(departing):
    return ' class="departs"' if departing else ""


def badge(result, control=None):
    """The verdict of a series or finding. A failure that its study expects (a negative control) is no alarm."""
    kind = KINDS.get(result.verdict, "control") if not control else "control"
    return f'<span class="badge {kind if result.as_expected else "bad"}">{escape(result.verdict)}</span>'


def expected(result):
    return "yes" if result.as_expected else f"<strong>no</strong>, expected {escape(result.expected)}"


def variable(text):
    return {"h": "<var>h</var>", "max(h,delta)": "max(<var>h</var>, <var>δ</var>)"}.get(text, escape(text))


# ------------------------------------------------------------------------------------------------------------ numbers

def value(number):
    return f"{number:.4g}" if math.isfinite(number) else str(number)


def error(number):
    return f"{number:.3e}" if math.isfinite(number) else f'<strong class="warning">{number}</strong>'


def seconds(number):
    return f"{number:.3g}" if math.isfinite(number) else "–"


def several(n, noun):
    return f"{n} {noun}" + ("" if n == 1 or noun.endswith("s") else "s")


def count(number):
    """Groups of three digits apart by a narrow space, as tables of large numbers are set."""
    return f"{number:,}".replace(",", "\u202f")
