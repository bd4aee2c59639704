"""Parts of a report's page: templates, badges, numbers. What is not Markup is escaped where it is set into a page."""

import json
import math
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

HERE = Path(__file__).parent
SCRIPTS = ("state.js", "tables.js", "figures.js", "explorer.js", "main.js")
STYLES = ("page.css", "figures.css", "media.css")

# How a verdict is to be read; its badge also carries its name, so that color is never the only sign.
KINDS = {"confirmed": "good", "holds": "good", "pre-asymptotic": "near", "floor": "fair", "inconclusive": "fair"}
BAR = Markup("<br>")

_templates = Environment(loader=FileSystemLoader(HERE / "templates"), autoescape=True, trim_blocks=True,
                         lstrip_blocks=True, undefined=StrictUndefined)


def render(template, **context):
    """A template of this folder with what it names."""
    return Markup(_templates.get_template(template).render(context))


def style(figures_in_dark=""):
    """All rules of the page but the fonts of its figures; dark where the reader has chosen so, else where the system is,
    and never on paper. figures_in_dark: declarations of the colors of figures."""
    dark = (HERE / "dark.css").read_text(encoding="utf-8") + figures_in_dark
    rules = "".join((HERE / name).read_text(encoding="utf-8") for name in STYLES)
    return Markup(f"{rules}@media screen and (prefers-color-scheme: dark) {{ :root:not([data-theme=light]) {{\n{dark}}} }}\n"
                  f"@media screen {{ :root[data-theme=dark] {{\n{dark}}} }}\n")


def script():
    """The page's script."""
    return Markup("".join((HERE / "script" / name).read_text(encoding="utf-8") for name in SCRIPTS))


def data(value):
    """Text of JSON that may stand in a script element."""
    return Markup(json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"))


def joined(parts, between=""):
    """Parts one after another, `between` them."""
    return Markup(between).join(parts)


# ----------------------------------------------------------------------------------------------------------- verdicts

def outcome(departing, what):
    """What came out in a sentence: `departing` and `what` are {noun: number}."""
    total = " and ".join(f"{number} {noun}" for noun, number in what.items() if number)
    if not total:
        kind, said = "good", "No series has been run"
    elif any(departing.values()):
        kind = "bad"
        said = " and ".join(f"{departing[noun]} of {number} {noun}" for noun, number in what.items() if number)
        said += " not as expected"
    else:
        kind, said = "good", f"All {total} are as expected"
    return Markup('<p class="outcome {}">{}.</p>\n').format(kind, said)


def badge(result, control=None):
    """The verdict of a series or finding. A failure that its study expects (a negative control) is no alarm."""
    kind = KINDS.get(result.verdict, "control") if not control else "control"
    return tag(result.verdict, kind if result.as_expected else "bad")


def tag(text, kind):
    return Markup('<span class="badge {}">{}</span>').format(kind, text)


def expected(result):
    return "yes" if result.as_expected else Markup("<strong>no</strong>, expected {}").format(result.expected)


def note(text):
    """Text beside what counts more; nothing for none."""
    return Markup('<span class="note">{}</span>').format(text) if text else ""


def link(target, text):
    """A link to a place of the page."""
    return Markup('<a href="#{}">{}</a>').format(target, text)


def variable(text):
    return {"h": Markup("<var>h</var>"), "max(h,delta)": Markup("max(<var>h</var>, <var>δ</var>)")}.get(text, escape(text))


# ------------------------------------------------------------------------------------------------------------ numbers

def value(number):
    return f"{number:.4g}" if math.isfinite(number) else str(number)


def error(number):
    return f"{number:.3e}" if math.isfinite(number) else Markup('<strong class="warning">{}</strong>').format(number)


def seconds(number):
    """Two digits: times of studies, which run once unless one asks for more, repeat to a few percent."""
    if not math.isfinite(number):
        return "–"
    return f"{number:.2g}" if number < 10 else f"{number:.0f}"


def several(n, noun):
    return f"{n} {noun}" + ("" if n == 1 or noun.endswith("s") else "s")


def count(number):
    """Groups of three digits apart by a narrow space, as tables of large numbers are set."""
    return f"{number:,}".replace(",", "\u202f")
