"""Stability maps: where steps are stable, as maps, as curves and as a table."""
