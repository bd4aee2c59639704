"""The look of every figure: typography, colors, and how a figure becomes files."""

from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
import io
import re

from drawing import undocumented    # before all that it is about
import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from drawing import hover, svg, texts
from drawing.panel import Panel

# Okabe and Ito's colors, told apart by readers of every color vision; their yellow is left out: too pale for a line.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
MARKERS = ("o", "s", "^", "D", "v", "<")
DASHES = ("solid", (0, (5, 1.6)), (0, (6, 1.4, 1.2, 1.4)), (0, (2.2, 1.2)),
          (0, (4, 1.1, 1, 1.1, 1, 1.1)), (0, (1, 1)))
GRAY, DEPARTING = "#595959", "#A40E26"
WIDTH = 9.0             # inches; at 100 px an inch the 900 px of a page
LINE = 0.148            # inches that a line of a legend takes
TYPOGRAPHY = {
    "font.family": "STIXGeneral", "mathtext.fontset": "stix", "font.size": 11, "axes.labelsize": 12,
    "axes.titlesize": 12.5, "axes.titley": 1.0,     # a fixed place: searching for one costs a third of the drawing
    "axes.linewidth": 0.7, "axes.edgecolor": "#333333", "xtick.direction": "in", "ytick.direction": "in",
    "xtick.major.width": 0.7, "ytick.major.width": 0.7, "xtick.minor.width": 0.5, "ytick.minor.width": 0.5,
    "lines.linewidth": 1.4, "lines.markersize": 5.5, "lines.markeredgewidth": 1.2, "legend.fontsize": 10,
    "svg.fonttype": "none", "svg.hashsalt": "acstudy"}
FORMATS = ("svg", "png", "pdf")     # of files of a figure
_METADATA = {"svg": {"Date": None}, "png": {"Software": None}, "pdf": {"CreationDate": None}}
LEGEND = {"frameon": False, "borderaxespad": 0, "borderpad": 0, "handlelength": 3.0, "handletextpad": 0.6,
          "labelspacing": 0.55}

texts.measure_once()


@contextmanager
def typography():
    """The look of every figure, whatever the user's matplotlibrc says."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(TYPOGRAPHY)
        yield


@dataclass(frozen=True)
class Drawing:
    """A figure of a report and what the page says about it."""
    stem: str               # of its files; a study's name, or one followed by a dot and a slug: no two studies collide
    title: str
    makes: object           # matplotlib's figure, or what makes it when it is asked for; None once it is rendered
    alt: str
    caption: str            # how to read it
    statements: tuple = ()  # of theory that it shows; empty: those of its whole study
    says: str = ""          # what to see in it, a sentence made of the results
    inline: str = ""        # the figure as an element of a page, once it is rendered; see svg.inline
    curves: tuple = ()      # hover.Curve of each that is marked, once it is rendered
    files: dict = field(default_factory=dict)   # content by extension, once it is rendered: those asked for

    @cached_property
    def figure(self):
        """matplotlib's; None once it is rendered."""
        return self.makes() if callable(self.makes) else self.makes


def slug(text):
    """A part of a file name that says `text`."""
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")


def blank(height, width=WIDTH):
    """An empty figure, in inches."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def add_axes(figure, left, bottom, width, height, kind=Panel, **more):
    """Axes of this `kind` at a place given in inches from the figure's lower left corner."""
    across, up = figure.get_size_inches()
    return figure.add_axes(kind(figure, (left / across, bottom / up, width / across, height / up), **more))


def foot_legend(figure, left, keys, texts, columns, spacing=2.0, bottom=0.1, **more):
    """A legend whose lower left corner is at a place in inches. `texts`: as matplotlib sets them."""
    return figure.legend(keys, texts, loc="lower left", ncol=columns, columnspacing=spacing,
                         bbox_to_anchor=(left / WIDTH, bottom / figure.get_figheight()), **LEGEND | more)


def mark_departing(panel, x, y, width=4):
    """A wide pale red line behind the curve of what is not as expected."""
    panel.plot(x, y, color=DEPARTING, linewidth=width, alpha=0.35, zorder=1)


def render(drawing, formats=()):
    """The drawing with its figure as an element of a page and as files of these of FORMATS, and without matplotlib's."""
    curves = hover.curves(drawing.figure)
    drawn = _saved(drawing.figure, drawing.title, "svg").decode()
    files = {kind: svg.readable(drawn).encode() if kind == "svg" else _saved(drawing.figure, drawing.title, kind)
             for kind in formats}
    return replace(drawing, inline=svg.inline(drawn, drawing.stem, drawing.alt), curves=curves, files=files,
                   makes=None)


def image(figure, title, kind):
    """The figure as a file of one of FORMATS, with no date inside."""
    saved = _saved(figure, title, kind)
    return svg.readable(saved.decode()).encode() if kind == "svg" else saved


def _saved(figure, title, kind):
    buffer = io.BytesIO()
    with typography():
        figure.savefig(buffer, format=kind, dpi=150, metadata=_METADATA[kind] | {"Title": title})
    return buffer.getvalue()
