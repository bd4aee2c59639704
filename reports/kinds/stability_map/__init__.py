"""Stability maps: where steps are stable, as maps, as curves and as a table."""

from kinds import kind
from kinds.stability_map import growth, limits, maps, positivity, table


def drawings(study, styles):
    return [drawing for part in (maps, limits, growth, positivity) for drawing in part.drawings(study)]


def _section(study, drawings, entries):
    return kind.section(study, drawings, entries, below=table.html(study))


KIND = kind.Kind(drawings, _section)
