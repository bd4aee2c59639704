#!/usr/bin/env python3
"""Prints the claims as a Markdown table, from result files: python3 scripts/claims.py [OUT_DIR]

A row per theorem, scheme and study; paths, observed orders and verdicts in the same sequence.
Exit codes: 0 done; 1 a series departs from what its study expects (its row says so); 2 no result file, or not one.
"""

import json
from pathlib import Path
import sys

DEFAULT = "reports/out"
HEADER = ("theorem", "promises", "Model", "study", "delta", "observed orders", "verdicts", "figure")


def main(arguments):
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        asked = arguments in (["-h"], ["--help"])
        print(__doc__.strip(), file=sys.stdout if asked else sys.stderr)
        return 0 if asked else 2
    folder = Path(arguments[0] if arguments else DEFAULT)
    files = sorted(folder.glob("*.json"))
    if not files:
        return fail(f"{folder}: no result file (*.json) in it; run make studies first, or name the folder")
    claims = {}
    for file in files:
        try:
            study = json.loads(file.read_text(encoding="utf-8"))
            for series in study.get("series", []):  # other kinds have findings
                claims.setdefault(claim(study, series, folder), []).append(series)
            rows = [row(key, claims[key]) for key in sorted(claims)]
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            return fail(f"{file}: not a result file of acstudy: {error!r}; remove it, or run its study again")
    for cells in (HEADER, ["---"] * len(HEADER), *rows):
        print("| " + " | ".join(cells) + " |")
    return 1 if any(not series["as_expected"] for group in claims.values() for series in group) else 0


def claim(study, series, folder):
    """What a row speaks about; the series of one row differ in their paths alone."""
    theory = series["theory"]
    theorem, _, limit = theory["statement"].partition(": ")
    promise = f"order {theory['order']:g} in {theory['variable']}" if theory["order"] else f"no convergence: {limit}"
    scheme = ["I" * series["model"]]
    if series["motion"] == "moving":
        scheme.append(f"{series['divergence']} divergence")
    scheme.append(series["kernel"] + (f"({series['alpha']:g})" if "alpha" in series else ""))
    if len({other["mu"] for other in study["series"] if "mu" in other}) > 1 and "mu" in series:
        scheme.append(f"mu = {series['mu']:g}")
    name = study["study"]
    figure = f"{name}.svg" if (folder / f"{name}.svg").is_file() else "not drawn"
    return theorem, promise, ", ".join(scheme), name, figure


def row(key, group):
    theorem, promise, scheme, study, figure = key
    paths = ", ".join(series["path"].removeprefix("delta = ") for series in group)
    orders = ", ".join(observed(series) for series in group)
    verdicts = ", ".join(verdict(series) for series in group)
    return theorem, promise, scheme, study, paths, orders, verdicts, figure


def observed(series):
    order = series["observed"]["order"]
    return "none" if order is None else f"{order:.2f}"


def verdict(series):
    if not series["as_expected"]:
        return f"**{series['verdict']}, expected {series['expected']}**"
    # "confirmed" is met by pre-asymptotic too; any other expectation is a control, and has to be told from a claim
    control = series["expected"] not in ("confirmed", "pre-asymptotic")
    return series["verdict"] + (" (as it should)" if control else "")


def fail(message):
    print(f"claims.py: {message}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
