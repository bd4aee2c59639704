"""The page in parts: a page for each question beside the first, and style and script that they share."""

import re

from writing import markup

FIRST = "index.html"
# Of a part that is about one question.
_NOTHING = dict(departing="", verdicts=(), headline="", in_numbers="", noticed=(), short_words="", cases="", origin="",
                seeded_absent="", compared_absent="")
_ID = re.compile(r'\sid="([^"]+)"')
_LINK = re.compile(r'<a href="#([^"]+)"')


def files(found):
    """{name: text}. `found`: what the template of the whole page names."""
    shared = {"page.css": f"{found['style']}{found['faces']}", "page.js": str(found["script"])}
    parts = {FIRST: dict(found, sections=())}
    for section in found["sections"]:
        parts[f"{section.question.anchor}.html"] = found | _NOTHING | dict(sections=[section])
    pages = {name: str(markup.render("page.html", **part, parts=True)) for name, part in parts.items()}
    own = {name: set(_ID.findall(text)) for name, text in pages.items()}
    where = {one: name for name, ids in reversed(own.items()) for one in ids}
    return shared | {name: _LINK.sub(lambda link: _led(link, own[name], where), text) for name, text in pages.items()}


def _led(link, own, where):
    """A link to a place of another part leads to its page."""
    if link[1] in own or link[1] not in where:
        return link[0]
    return f'<a href="{where[link[1]]}#{link[1]}"'
