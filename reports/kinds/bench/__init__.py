"""Benches: what was measured of run times and work, as figures and as tables."""
