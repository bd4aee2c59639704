#!/usr/bin/env python3
"""Prints what was observed of the theorems as a Markdown table, from result files: python3 scripts/claims.py [OUT_DIR]

A row per theorem, part and promise, over all convergence studies. Orders are the lowest and the highest observed.
Exit codes: 0 done; 1 a series departs from what its study expects (its row says so); 2 no result file, or not one.
"""

from collections import Counter
import json
from pathlib import Path
import sys

DEFAULT = "reports/out"
HEADER = ("theorem", "promises", "series", "kernels", "observed orders", "verdicts", "studies")


def main(arguments):
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        asked = arguments in (["-h"], ["--help"])
        print(__doc__.strip(), file=sys.stdout if asked else sys.stderr)
        return 0 if asked else 2
    folder = Path(arguments[0] if arguments else DEFAULT)
    files = sorted(folder.glob("*.json"))
    if not files:
        return fail(f"{folder}: no result file (*.json) in it; run make studies first, or name the folder")
    claims, departs = {}, False
    for file in files:
        try:
            study = json.loads(file.read_text(encoding="utf-8"))
            # A study that is judged by findings is on the report's page of claims.
            for series in study["series"] if study.get("kind", "convergence") == "convergence" else ():
                departs |= not series["as_expected"]
                if series["expected"] in ("stable", "unstable") or "reference" in series:
                    continue    # no order is asked for, or the limit is not known and no theorem is judged
                claims.setdefault(claim(series), []).append((study["study"], series))
            rows = [row(key, claims[key]) for key in sorted(claims)]
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            return fail(f"{file}: not a result file of acstudy: {error!r}; remove it, or run its study again")
    for cells in (HEADER, ["---"] * len(HEADER), *rows):
        print("| " + " | ".join(cells) + " |")
    return 1 if departs else 0


def claim(series):
    """What a row speaks about."""
    theory = series["theory"]
    theorem, _, limit = theory["statement"].partition(": ")
    promise = f"order {theory['order']:g} in {theory['variable']}" if theory["order"] else f"no convergence: {limit}"
    return theorem, promise


def row(key, group):
    kernels = dict.fromkeys(kernel(series) for _, series in group)
    verdicts = Counter(verdict(series) for _, series in group)
    orders = [series["observed"]["order"] for _, series in group if series["observed"]["order"] is not None]
    observed = f"{min(orders):.2f} – {max(orders):.2f}" if orders else "none"
    return (*key, str(len(group)), ", ".join(kernels), observed,
            ", ".join(f"{count} {name}" for name, count in sorted(verdicts.items())),
            ", ".join(dict.fromkeys(study for study, _ in group)))


def kernel(series):
    return series["kernel"] + (f"({series['alpha']:g})" if "alpha" in series else "")


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
