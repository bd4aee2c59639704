"""Figures in the page: the drawing itself, what to see in it, and what its script tells of its curves."""

from markupsafe import Markup

from writing import markup, tables

AT_ONCE = 2     # figures of a study that are not folded


def shown(drawings):
    """All figures of a study, those after the first ones folded."""
    parts = [figure(drawing) for drawing in drawings[:AT_ONCE]]
    more = drawings[AT_ONCE:]
    if more:
        said = Markup("{} {}").format(markup.several(len(more), "more figure"),
                                      markup.note("; ".join(drawing.title.rpartition(": ")[2] for drawing in more)))
        parts.append(tables.fold(said, markup.joined(map(figure, more))))
    return parts


def figure(drawing):
    """A drawing.look.Drawing with what to see, and what is said of its points."""
    curves = [[curve.key, curve.name, curve.about, curve.columns, curve.points] for curve in drawing.curves
              if curve.points]
    return markup.render("figure.html", drawing=drawing, svg=Markup(drawing.inline),
                         curves=markup.data(curves) if curves else "")
