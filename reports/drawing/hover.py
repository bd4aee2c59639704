"""What a reader is told who points at a curve: which series it belongs to, and what each of its points says."""

from dataclasses import dataclass
import math
import re

import numpy as np

_ATTRIBUTE = "said_of_points"


@dataclass(frozen=True)
class Curve:
    """A curve of a figure. Places are in units of the SVG, from its upper left corner."""
    key: str        # of its series, the same in every panel; the SVG names its artists "s:<key>", its legend "l:<key>"
    name: str       # of its series, as its legend has it
    about: str      # of the curve as a whole
    columns: tuple  # names of what is said of a point
    points: tuple   # (x, y, text of each column)


def key(name):
    """The key of the series of this name."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def mark(artist, name, about="", **columns):
    """Says of a plotted curve, or a container of errorbar, which series it is, and of each of its points the `columns`.

    columns: {name: values}, numbers or text, as many as the curve has points, those that cannot be drawn included.
    """
    parts = [artist] if not hasattr(artist, "get_children") or not isinstance(artist, tuple) else artist.get_children()
    for part in parts:
        part.set_gid(f"s:{key(name)}")
    told = {column: [_text(value) for value in values] for column, values in columns.items()}
    setattr(parts[0], _ATTRIBUTE, (name, about, told))


def mark_legend(legend, series):
    """Names the entries of a legend after the series that they stand for; None: of no series."""
    handles = getattr(legend, "legend_handles", None) or legend.legendHandles     # before matplotlib 3.7
    for handle, text, name in zip(handles, legend.get_texts(), series):
        if name is not None:
            handle.set_gid(f"l:{key(name)}")
            text.set_gid(f"l:{key(name)}")


def curves(figure):
    """All marked curves of a figure, with the points that are seen."""
    found = []
    height = figure.get_figheight()
    # Not figure.findobj(), which makes all ticks of matplotlib's to look into them.
    for artist in (one for panel in figure.axes for one in panel.get_children() if hasattr(one, _ATTRIBUTE)):
        name, about, told = getattr(artist, _ATTRIBUTE)
        with np.errstate(all="ignore"):
            places = artist.get_transform().transform(np.asarray(artist.get_xydata(), dtype=float)) / figure.dpi
        left, bottom, right, top = (side / figure.dpi for side in artist.axes.bbox.extents)
        texts = list(zip(*told.values()))
        points = tuple((round(72 * x, 1), round(72 * (height - y), 1), *text) for (x, y), text in zip(places, texts)
                       if left - 0.1 <= x <= right + 0.1 and bottom - 0.1 <= y <= top + 0.1)
        found.append(Curve(key(name), name, about, tuple(told), points))
    return tuple(found)


def _text(value):
    if isinstance(value, str):
        return value
    if isinstance(value, (int, np.integer)):
        return str(value)
    return f"{value:.4g}".replace("-", "−") if math.isfinite(value) else "–"
