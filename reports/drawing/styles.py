"""How the curves of schemes look: a scheme looks the same in every figure."""

from dataclasses import dataclass

from drawing.look import COLORS, DASHES, MARKERS


@dataclass(frozen=True)
class Style:
    """How the curves of one scheme look; marker and fill show kernel and divergence form, the color the scheme."""
    color: str
    marker: str
    dash: object
    filled: bool

    def line(self, **more):
        # An open marker is wider than a filled one and see-through: where the two forms agree, both stay visible.
        return dict(color=self.color, marker=self.marker, linestyle=self.dash,
                    markerfacecolor=self.color if self.filled else "none", markersize=4.4 if self.filled else 7.0,
                    zorder=3 if self.filled else 4, **more)


def styles_of(schemes):
    """{scheme: style}, in order of appearance."""
    styles, families = {}, []
    for scheme in schemes:
        if scheme in styles:
            continue
        family = (scheme.model, scheme.label, scheme.kernel, scheme.alpha, scheme.mu)
        if family not in families:
            families.append(family)
        i = len(styles)
        styles[scheme] = Style(COLORS[i % len(COLORS)], MARKERS[families.index(family) % len(MARKERS)],
                               DASHES[i % len(DASHES)], scheme.divergence != "nonlocal")
    return styles
