"""Figures in the page: the drawing itself, what to see in it, and what its script tells of its curves."""

from markupsafe import Markup

from writing import markup


def figure(drawing):
    """A drawing.look.Drawing with what to see, and what is said of its points."""
    curves = [[curve.key, curve.name, curve.about, curve.columns, curve.points] for curve in drawing.curves
              if curve.points]
    return markup.render("figure.html", drawing=drawing, svg=Markup(drawing.inline),
                         curves=markup.data(curves) if curves else "")
