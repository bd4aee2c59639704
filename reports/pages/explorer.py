"""The cases of all series as data, from which the page's script draws any quantity over any other."""

import math

from reading import names

QUANTITIES = (("error_linf", "max-norm error"), ("error_l1", "error in L1"), ("error_l2", "error in L2"),
              ("seconds", "seconds"), ("work_pairs", "pair interactions"), ("N", "N"), ("h", "h"), ("delta", "δ"),
              ("ratio", "δ/h"), ("steps", "steps"))


def data(studies):
    """{"quantities": names, "series": [{what it is, "cases": a list for each quantity}]}; None without series.

    Differences to a finer run are no errors; they are left out.
    """
    found = [_series(study, finding) for study in studies if study.scene and study.scene.u
             for finding in (*study.findings, *study.evidence) if finding.series and len(finding.series.cases)]
    return {"quantities": [name for _, name in QUANTITIES], "series": found} if found else None


def _series(study, finding):
    series, cases = finding.series, finding.series.cases
    columns = {"ratio": cases.delta / cases.h}
    return {
        "study": study.name, "scene": study.scene.name or study.name, "scheme": _without_kernel(series.scheme),
        "kernel": _kernel(series.scheme), "path": series.path, "steps": series.stepping or series.step_text,
        "source": series.source, "order": f"{names.order(finding.observed_order)} [{names.order(finding.observed_low)}, "
        f"{names.order(finding.observed_high)}]", "verdict": finding.verdict,
        "cases": [[_short(value) for value in (columns.get(stored) if stored in columns else getattr(cases, stored))]
                  for stored, _ in QUANTITIES]}


def _without_kernel(scheme):
    return ", ".join(filter(None, (names.model(scheme), f"{scheme.divergence} divergence" if scheme.divergence else "")))


def _kernel(scheme):
    return scheme.kernel + (f"({scheme.alpha:g})" if scheme.alpha is not None else "")


def _short(value):
    """Four digits, which is more than a picture shows; None for what is no number."""
    if not math.isfinite(value):
        return None
    return int(value) if float(value).is_integer() and abs(value) < 1e9 else float(f"{value:.4g}")
