"""Makes matplotlib's SVG small enough that a page holds all figures at once, in colors that the page decides.

Of matplotlib's groups, identifiers and styles only those stay that are needed. Colors become custom properties with
what was drawn as their fallback, so that a page that sets none shows the figure as it was drawn.
"""

from functools import lru_cache
from itertools import groupby
import re
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

# What colors become on a dark page; those that are not here stand for values, as in a map, and stay what they are.
DARK = {"#000000": "#e8ebee", "#ffffff": "#14181d", "#333333": "#c3c9cf", "#595959": "#a9b1ba", "#c4c9ce": "#5b636c",
        "#c8c8c8": "#60666d", "#d3d3d3": "#4a5158", "#d8dee4": "#3a424a", "#edf0f3": "#262c33", "#dce9f3": "#22364a",
        "#0072b2": "#4fa3f7", "#d55e00": "#ff8b3d", "#009e73": "#2cc79a", "#cc79a7": "#e59cc8", "#e69f00": "#f2b632",
        "#56b4e9": "#9ad6fa", "#a40e26": "#ff7085"}
SERIES = "s:"       # begins the gid of what is drawn of a series; its key follows
LEGEND = "l:"       # the same of what a legend shows of it
# An identifier that matplotlib made up.
_MADE_UP = re.compile(r"[A-Za-z0-9.]+_\d+$")
_DECIMALS = re.compile(r"(?<=\.\d\d)\d+")
_ZEROS = re.compile(r"\.00?(?!\d)|(?<=\.\d)0(?!\d)")
_DRAWN_STROKE = re.compile(r"M[^A-Za-z]+[hv][^A-Za-z]+")
_REFERENCE = re.compile(r"url\(#([^)]+)\)")
_FONT = re.compile(r"(italic )?([\d.]+)px ")
_TURNED_BY_NOTHING = re.compile(r"rotate\(-?0 [^)]*\)$")
_MOVED = re.compile(r"translate\((\S+) (\S+)\)$")
_STROKE = re.compile(r"M (\S+) (\S+)\s+L (\S+) (\S+)\s*$")
_DROPPED = ("title", "metadata", "style")
_USUAL = {"stroke-dashoffset": "0", "text-anchor": "start", "stroke-width": "1"}
# What a group may say for all that is in it.
_SHARED = ("fill", "fill-opacity", "stroke", "stroke-dasharray", "stroke-dashoffset", "stroke-linecap", "stroke-linejoin",
           "stroke-opacity", "stroke-width", "font-size", "font-style", "text-anchor", "clip-path")


def compact(svg, stem, family, label):
    """The SVG text `svg` as matplotlib writes it, as an element for a page; see svg.inline."""
    bare = re.sub(r' xmlns(:xlink)?="[^"]*"', "", svg.replace("xlink:href", "href"))
    bare = re.sub(r"<metadata>.*?</metadata>", "", bare, flags=re.DOTALL)
    figure = _Figure(stem)
    root = ElementTree.fromstring(bare)
    found = Element("svg", {"class": "drawing", "viewBox": _rounded(root.get("viewBox")), "role": "img", "aria-label": label,
                            "font-family": family, "fill": color("#000000"), "stroke-linejoin": "round", "data-figure": stem})
    found.extend(_grouped(figure.parts(root)))
    return ElementTree.tostring(found, encoding="unicode")


def color(value):
    """A color #rrggbb as a custom property, if DARK has it, else as it is."""
    value = value.lower()
    return f"var({_property(value)},{value})" if value in DARK else value


def dark(svg):
    """The declarations that turn the colors of one or more figures, as compact() gives them, into those of DARK."""
    return "".join(f"{_property(light)}:{dark};" for light, dark in DARK.items() if _property(light) in svg)


def _property(value):
    return {"#000000": "--ink", "#ffffff": "--paper"}.get(value) or f"--c-{value[1:]}"


class _Figure:
    """A figure on its way: what its identifiers become, and marks that are but a stroke, by identifier."""

    def __init__(self, stem):
        self.stem, self.ids, self.strokes = stem, {}, {}

    def parts(self, element):
        """What stays of the contents of an element."""
        return [part for child in element for part in self._part(child)]

    def _part(self, element):
        tag = element.tag
        if tag in _DROPPED:
            return []
        if tag == "defs":
            return self._definitions(element)
        if tag == "g":
            return self._group(element)
        if tag == "use" and element.get("href")[1:] in self.strokes:
            return [self._stroke(element)]
        made = Element(tag, self._attributes(element))
        made.extend(self.parts(element))
        if tag in ("text", "tspan"):
            made.text = element.text
        if tag == "text" and len(made):
            _tidy_formula(made)
        return [made]

    def _definitions(self, element):
        found = Element("defs")
        for child in element:
            stroke = _STROKE.match(child.get("d", ""))
            # Across or upright, as ticks and caps of bars are.
            if stroke and (stroke[1] == stroke[3] or stroke[2] == stroke[4]):
                self.strokes[child.get("id")] = [float(number) for number in stroke.groups()]
                continue
            if child.tag == "path":
                child.attrib.pop("style", None)     # stands again where the mark is used
            found.extend(self._part(child))
        return [found] if len(found) else []

    def _stroke(self, use):
        x1, y1, x2, y2 = self.strokes[use.get("href")[1:]]
        x, y = float(use.get("x")), float(use.get("y"))
        length = f"h{x2 - x1:.2f}" if y1 == y2 else f"v{y2 - y1:.2f}"
        return Element("path", {"d": _rounded(f"M{x + x1:.2f} {y + y1:.2f}{length}"), **_style(use.get("style"))})

    def _group(self, element):
        name = element.attrib.pop("id", "")
        attributes, parts = self._attributes(element), self.parts(element)
        if name.startswith("matplotlib.axis_"):
            parts.sort(key=lambda part: (not _is_stroke(part), _shared_style(part)) if _is_stroke(part) else (True, ()))
        parts = list(_joined(parts))
        if name and not _MADE_UP.match(name):
            attributes |= ({"data-series": name.removeprefix(SERIES)} if name.startswith(SERIES) else
                           {"data-legend": name.removeprefix(LEGEND)} if name.startswith(LEGEND) else
                           {"id": f"{self.stem}.{name}"})
        elif attributes and all(part.tag == "text" for part in parts) and "transform" not in attributes:
            for text in parts:
                _place(text, attributes)
            return parts
        if not attributes:
            return parts
        if "x" in attributes:
            attributes["transform"] = f'translate({attributes.pop("x")} {attributes.pop("y")})'
        made = Element("g", attributes)
        made.extend(_grouped(parts))
        return [made]

    def _id(self, name):
        return self.ids.setdefault(name, f"{self.stem}.{len(self.ids)}")

    def _attributes(self, element):
        found = {}
        for name, value in element.attrib.items():
            if name == "style":
                found |= _style(value)
            elif name == "id":
                found["id"] = self._id(value)
            elif name == "href":
                found["href"] = f"#{self._id(value[1:])}"
            elif name == "transform" and _TURNED_BY_NOTHING.match(value):
                continue
            elif name == "transform" and (place := _MOVED.match(value)):
                found["x"], found["y"] = map(_rounded, place.groups())
            elif name == "d":
                found["d"] = re.sub(r"\s*([A-Za-z])\s*", r"\1", _rounded(value)).strip()
            elif name.endswith("}space"):
                if element.text != " ".join(element.text.split()):
                    found["style"] = "white-space:pre"
            else:
                found[name] = _rounded(value)
        return {name: _REFERENCE.sub(lambda one: f"url(#{self._id(one[1])})", value) if "url(" in value else value
                for name, value in found.items()}


def _rounded(text):
    """The text with its decimal numbers cut after hundredths of a point."""
    return _ZEROS.sub("", _DECIMALS.sub("", text)) if "." in text else text


@lru_cache(maxsize=4096)
def _style(text):
    """A style as attributes, without what is usual and in colors of the page."""
    found = dict(part.split(": ", 1) for part in text.split("; "))
    if found.get("fill-opacity") == "0":
        found = {**found, "fill": "none"}
        del found["fill-opacity"]
    if font := _FONT.match(found.pop("font", "")):
        found["font-size"] = _rounded(font[2])
        if font[1]:
            found["font-style"] = "italic"
    return {name: color(value) if value.startswith("#") else _rounded(value) for name, value in found.items()
            if _USUAL.get(name) != value}


def _is_stroke(part):
    return part.tag == "path" and bool(_DRAWN_STROKE.match(part.get("d", "")))


def _joined(parts):
    """Strokes of one look beside one another as one path."""
    for key, group in groupby(parts, lambda part: _shared_style(part) if _is_stroke(part) else None):
        first, *others = group
        if key is None:
            yield from (first, *others)
            continue
        first.set("d", first.get("d") + "".join(other.get("d") for other in others))
        yield first


def _shared_style(part):
    """What a group might say in place of a part; () for one that has to say it itself."""
    if part.tag in ("g", "defs") or "transform" in part.attrib:
        return ()
    return tuple((name, part.get(name)) for name in _SHARED if name in part.attrib)


def _grouped(parts):
    """Parts of one look beside one another in a group that says it once."""
    for key, group in groupby(parts, _shared_style):
        group = list(group)
        if len(group) < 2 or not key:
            yield from group
            continue
        made = Element("g", dict(key))
        for part in group:
            for name, _ in key:
                del part.attrib[name]
            made.append(part)
        yield made


def _place(text, attributes):
    """Moves a text to the place in `attributes`, which also say how it looks."""
    rest = {name: value for name, value in attributes.items() if name not in ("x", "y")}
    text.attrib = {**rest, **text.attrib}
    for one in list(text) or [text]:
        for name in ("x", "y"):
            if name in attributes:
                one.set(name, _rounded(f"{float(one.get(name, 0)) + float(attributes[name]):.2f}"))
    for before, one in reversed(list(zip(text, list(text)[1:]))):
        if one.get("y") == before.get("y"):
            del one.attrib["y"]


def _tidy_formula(text):
    """What all runs of a formula have in common is said once."""
    for name in ("font-size", "font-style"):
        values = {run.get(name) for run in text}
        if len(values) == 1 and None not in values:
            text.set(name, values.pop())
            for run in text:
                del run.attrib[name]
