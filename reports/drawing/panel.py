"""Axes whose ticks cost next to nothing: matplotlib makes five objects of each, which took half of a report's time."""

from matplotlib.axes import Axes
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.spines import Spine
from matplotlib.text import Annotation, Text
from matplotlib.ticker import FixedFormatter, FixedLocator
from matplotlib.transforms import IdentityTransform, ScaledTranslation
import numpy as np

MAJOR, MINOR = (3.5, 0.7), (2.0, 0.5)       # length and width of a tick, in points
PAD = 3.5                                   # points between a tick and its label


class Panel(Axes):
    """Axes for figures on paper: locators, labels and titles as usual; ticks are drawn once, when it is drawn.

    follows: limits that are not set follow what is drawn, which takes a tenth of its time.
    Ticks stand at the bottom and the left, pointing inward, until tick_params() says otherwise; of its parameters,
    `direction` and those that show ticks and labels of a side have an effect. There is no grid.
    """

    def __init__(self, *args, follows=False, **more):
        self._shown, self._follows = {}, follows
        super().__init__(*args, **more)
        self.set_autoscale_on(follows)
        self._shown = {"bottom": True, "left": True, "labelbottom": True, "labelleft": True}
        for axis in (self.xaxis, self.yaxis):
            axis.set_visible(False)
            axis.reset_ticks = _nothing     # spines call it when they are placed
        for side, spine in self.spines.items():     # as ticks would do
            spine.set_transform(self._along(side in ("bottom", "top")))

    def _gen_axes_spines(self, *_, **__):
        return {side: _Edge.linear_spine(self, side) for side in ("left", "right", "bottom", "top")}

    def _gen_axes_patch(self):
        return _Ground((0.0, 0.0), 1.0, 1.0)

    def _update_line_limits(self, line):
        if self._follows:
            super()._update_line_limits(line)

    def _update_patch_limits(self, patch):
        if self._follows:
            super()._update_patch_limits(patch)

    def grid(self, *_, **__):
        """Nothing: a grid would make matplotlib's ticks."""

    def set_axis_on(self):
        """Called while axes are made, and then ticks would be, to be clipped."""
        super().set_axis_on()
        for axis in (self.xaxis, self.yaxis):
            axis.majorTicks, axis.minorTicks = [], []

    def tick_params(self, axis="both", **shown):
        self._shown |= shown

    def set_xticks(self, ticks, labels=None):
        _fix(self.xaxis, ticks, labels)

    def set_yticks(self, ticks, labels=None):
        _fix(self.yaxis, ticks, labels)

    def draw(self, renderer):
        """Ticks and labels are there while it is drawn, for their places depend on the fonts of the file."""
        added = [*self._ticks(MAJOR, "get_majorticklocs"), *self._ticks(MINOR, "get_minorticklocs"),
                 *self._labels(self.xaxis, "bottom", renderer), *self._labels(self.yaxis, "left", renderer)]
        for artist in added:
            self.add_artist(artist)
        super().draw(renderer)
        for artist in added:
            artist.remove()

    def _ticks(self, look, places_of):
        """All major or all minor ticks, as one path in pixels."""
        length, width = look
        length *= self.figure.dpi / 72 * (-1 if self._shown.get("direction") == "out" else 1)
        lines = []
        for axis, sides in ((self.xaxis, ("bottom", "top")), (self.yaxis, ("left", "right"))):
            places = _inside(axis, getattr(axis, places_of)())
            for edge, side in enumerate(sides):
                if self._shown.get(side) and len(places):
                    across = side in ("bottom", "top")
                    at = np.column_stack((places, np.full(len(places), edge))[::1 if across else -1])
                    start = self._along(across).transform(at)
                    lines.append(np.stack((start, start + np.array((0, 1) if across else (1, 0))
                                           * length * (1 - 2 * edge)), axis=1))
        if lines:
            points = np.concatenate(lines).reshape(-1, 2)
            yield PathPatch(Path(points, [Path.MOVETO, Path.LINETO] * (len(points) // 2)), transform=IdentityTransform(),
                            linewidth=width, edgecolor="black", fill=False, clip_on=False, zorder=1.5,
                            capstyle="butt")

    def _labels(self, axis, side, renderer):
        """The labels of the ticks of an axis, and its own."""
        across = side == "bottom"
        major, labels = _within(axis)
        texts = []
        if self._shown[f"label{side}"]:
            outside = MAJOR[0] if self._shown.get("direction") == "out" else 0.0
            shift = -(PAD + outside) / 72
            shift = (0, shift) if across else (shift, 0)
            transform = self._along(across) + ScaledTranslation(*shift, self.figure.dpi_scale_trans)
            of_side = dict(va="top", ha="center") if across else dict(va="center_baseline", ha="right")
            for place, label in zip(major, labels):
                texts.append(Text(*((place, 0) if across else (0, place)), label, transform=transform, clip_on=False,
                                  zorder=1.5, figure=self.figure, **of_side))
        yield from texts
        if axis.label.get_text():
            # Those at the bottom are of one height.
            boxes = [text.get_window_extent(renderer) for text in (texts[:1] if across else texts)]
            yield self._name(axis, across, boxes)

    def _along(self, across):
        """Data along the axis, parts of the panel at right angles to it."""
        return self.get_xaxis_transform() if across else self.get_yaxis_transform()

    def _name(self, axis, across, boxes):
        """The axis's label, beyond the `boxes` around labels of ticks."""
        reach = max((self.bbox.y0 - box.y0 if across else self.bbox.x0 - box.x0 for box in boxes), default=0.0)
        offset = -(72 * reach / self.figure.dpi + axis.labelpad)
        return Annotation(axis.label.get_text(), (0.5, 0) if across else (0, 0.5), xycoords=self.transAxes,
                          xytext=(0, offset) if across else (offset, 0), textcoords="offset points", ha="center",
                          va="top" if across else "bottom", rotation=0 if across else 90, rotation_mode="anchor",
                          fontproperties=axis.label.get_fontproperties(), annotation_clip=False, clip_on=False)


class _Ground(Rectangle):
    """The area of a panel: all that it clips asks where it is."""

    def get_patch_transform(self):
        if not hasattr(self, "_place"):
            self._place = super().get_patch_transform()
        return self._place


class _Edge(Spine):
    """An edge of a panel that leaves clearing its axis to the panel: matplotlib's edges do it eight times more."""

    def register_axis(self, axis):
        self.axis = axis

    def clear(self):
        self._position = None


def _nothing():
    """In place of what makes matplotlib's ticks."""


def _fix(axis, ticks, labels):
    axis.set_major_locator(FixedLocator(list(ticks)))
    if labels is not None:
        axis.set_major_formatter(FixedFormatter(list(labels)))


def _inside(axis, places):
    low, high = sorted(axis.get_view_interval())
    return np.array([place for place in places if low - 1e-9 * abs(low) <= place <= high + 1e-9 * abs(high)])


def _within(axis):
    """(places of the major ticks that are in the panel, their labels)."""
    every = list(axis.get_majorticklocs())
    labels = axis.get_major_formatter().format_ticks(every)
    places = _inside(axis, every)
    return places, [labels[every.index(place)] for place in places]
