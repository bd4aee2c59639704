"""Findings of stability maps, taken apart: of which measurement, scheme, particles and integrator each is."""

import math

import numpy as np

NORM, SPECTRAL = "sharp in the max norm", "sharp in the spectral radius"
# What the findings of a kind measure, as their coordinates call it.
MEASURES = {"map": "max norm of all steps to T", "growth curve": "max norm of all steps to t",
            "positivity": "smallest entry of a step", NORM: "largest CFL number, max norm",
            SPECTRAL: "largest CFL number, spectral radius"}
SEARCH_END = 1000.0     # CFL number at which the bisection for a limit ends: a limit of it is none
CAPPED = 1e299          # norms and bounds are capped at 1e300
WITHIN = 1 + 1e-6       # round-off of a product of many steps


def parts(finding):
    """(arrangement of the particles, integrator)."""
    return finding.coordinates["arrangement"], finding.coordinates.get("integrator", "")


def lemma(finding):
    return finding.coordinates.get("lemma", "")


def of_kind(study, kind):
    """The findings of a kind such as "map", whatever the lemma."""
    return [finding for finding in study.findings
            if finding.coordinates.get("measure") == MEASURES[kind] and len(finding.points)]


def lemma_suffices(finding):
    """Whether the sharp limit lies nowhere below a CFL number of 1; it is known to 1e-6."""
    return bool(np.all(finding.points.value >= 1 - 1e-6))


def plane(finding):
    """(delta/h [m], CFL number [n], value [n, m]), ascending; NaN where there is no value."""
    points = finding.points
    found = {(float(f"{delta / h:.6g}"), float(f"{cfl:.6g}")): value for delta, h, cfl, value
             in zip(points.delta, points.h, points.variable, points.value) if delta > 0 and h > 0 and cfl > 0}
    ratios, cfl = (np.array(sorted({key[i] for key in found})) for i in (0, 1))
    return ratios, cfl, np.array([[found.get((x, y), math.nan) for x in ratios] for y in cfl])


def allowed_growth(found):
    """exp(CT), as near as the bounds on growth over T come: their median at the smallest CFL number; 1 without any."""
    bounds = {}
    for finding in found:
        for cfl, upper in zip(finding.points.variable, finding.points.upper):
            if upper < CAPPED:
                bounds.setdefault(cfl, []).append(upper)
    return max(1.0, float(np.median(bounds[min(bounds)]))) if bounds else 1.0


def ordered(found, part):
    return list(dict.fromkeys(map(part, found)))


def subject_of(finding):
    return finding.subject


def integrator_of(finding):
    return parts(finding)[1]
