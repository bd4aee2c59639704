"""Makes the text of matplotlib's SVG readable on any machine: fonts inside, formulas in reading order.

matplotlib writes a formula glyph by glyph, sorted by font ("max(,)" and then "hδ"), with lists of positions that some
viewers ignore and no search finds. Here each formula becomes runs from left to right, each with one position. Text
stays text; the letters it needs of the fonts STIX come with it, as few machines have them and the layout is theirs.
"""

import base64
from functools import lru_cache
from html import escape, unescape
import io
import re

from matplotlib.font_manager import FontProperties, findfont

from drawing import inlined

# For viewers that take no font from a file; first those of the same widths as STIX.
SUBSTITUTES = "'STIX Two Text', 'Times New Roman', Times, 'Liberation Serif', 'Nimbus Roman', serif"
_FONT = re.compile(r"'?\b(STIX\w+)'?")
_RUN = re.compile(r'<tspan style="([^"]*)" x="([^"]*)" y="([^"]*)">([^<]*)</tspan>')
# matplotlib 3.10 says fonts part by part, and places before the style.
_FONT_IN_PARTS = re.compile(r"(?:font-style: (italic); )?font-size: ([\d.]+px); font-family: ([^;\"]+)")
_PLACE_FIRST = re.compile(r'<tspan (x="[^"]*" y="[^"]*") (style="[^"]*")>')
_FORMULA = re.compile(rf"(?:\s*{_RUN.pattern})+\s*")


def readable(svg):
    """matplotlib's SVG as a file: its formulas in reading order, its fonts embedded and named with substitutes."""
    svg = _FONT.sub(rf"\1, {SUBSTITUTES}", _in_reading_order(svg))
    return svg.replace("<defs>", f'<defs>\n  <style type="text/css">{faces(letters(svg))}</style>', 1)


def inline(svg, stem, label=""):
    """matplotlib's SVG as an element <svg class="drawing" data-figure="stem"> of a page that has faces() in its style.

    Identifiers begin with the figure's `stem` and a dot; what was drawn with the gid "s:KEY" is in groups with
    data-series="KEY". Colors are custom properties with what was drawn as their fallback: --ink for black, --paper for
    white, --c-rrggbb for others; inlined.dark() has their values on a dark page. `label`: what is said in place of the
    figure.
    """
    return inlined.compact(_in_reading_order(svg), stem, f"STIXGeneral, {SUBSTITUTES}", label)


def letters(*svgs):
    """The letters in the text of any of the SVG texts, in order."""
    return "".join(sorted(set(unescape("".join(found for svg in svgs for found in re.findall(r">([^<]+)</t", svg))))))


def faces(letters):
    """The fonts of figures, cut down to these letters, as rules for a style sheet."""
    return "".join(f"@font-face{{font-family:STIXGeneral;font-style:{style};"
                   f"src:url(data:font/woff;base64,{_font(style, letters)})}}\n" for style in ("normal", "italic"))


@lru_cache(maxsize=64)
def _font(style, letters):
    """STIXGeneral cut down to `letters`, as WOFF in base 64."""
    from fontTools import subset    # comes with matplotlib, which cuts fonts for PDF so; it loads as long as it cuts

    options = subset.Options(flavor="woff", layout_features=[], name_IDs=[0, 1, 2, 13], hinting=False)
    options.drop_tables += ["FFTM"]     # the font editor's dates
    cut, buffer = subset.Subsetter(options), io.BytesIO()
    cut.populate(text=letters)
    with subset.load_font(findfont(FontProperties(family="STIXGeneral", style=style)), options) as font:
        cut.subset(font)
        subset.save_font(font, buffer, options)
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def _in_reading_order(svg):
    """The SVG text with its formulas from left to right, and written as matplotlib 3.6 does."""
    svg = _FONT_IN_PARTS.sub(lambda font: f"font: {'italic ' if font[1] else ''}{font[2]} {font[3]}", svg)
    return _FORMULA.sub(_reordered, _PLACE_FIRST.sub(r"<tspan \2 \1>", svg))


def _reordered(formula):
    glyphs = []     # (x, y, style, character)
    for style, xs, ys, text in _RUN.findall(formula.group()):
        text, xs, ys = unescape(text), xs.split(), ys.split()
        ys = ys * len(text) if len(ys) == 1 else ys
        if not len(text) == len(xs) == len(ys):
            return formula.group()
        glyphs += zip(map(float, xs), map(float, ys), [style] * len(text), text)
    runs = []
    for x, y, style, character in sorted(glyphs, key=lambda glyph: glyph[0]):
        word = "italic" not in style and (character.isalpha() or character in " \u00a0-")
        if runs and word and runs[-1]["word"] and runs[-1]["style"] == style and runs[-1]["y"] == y:
            runs[-1]["text"] += character
        else:
            runs.append({"x": x, "y": y, "style": style, "text": character, "word": word})
    return "".join(f'<tspan style="{run["style"]}" x="{run["x"]:g}" y="{run["y"]:g}" xml:space="preserve">'
                   f'{escape(run["text"])}</tspan>' for run in runs)
