"""What benches measured as tables: seconds to reach an error, the law of cost, the prices of work, threads."""

import math

from markupsafe import Markup

from kinds.bench import ways
from kinds.bench.texts import seconds
from reading import bench_results, names, work_precision

KINDS = {"between": "{}", "coarsest": "< {}", "beyond": "~ {} *", "not": "not reached", "none": "no solution"}
REACH_NOTE = ("`<`: already the coarsest level is better, in this time. `*`: extrapolated from the two finest levels, "
              f"to {work_precision.FARTHEST:g} times the finest N at most; not reached: farther than that.")
LAW_NOTE = ("delta/h counts as 1 below 1. Brackets: 95 % intervals, from resampled cases; rms: how far cases are from "
            f"the law. Left out: times below {1e3 * work_precision.SHORTEST:g} ms or with a deviation above "
            f"{100 * work_precision.NOISE:g} %, and paths with a nonlocal source.")
PRICE_NOTE = ("seconds = set-up + ns per update N steps stages + ns per pair pairs, fitted to the same paths, short "
              "times included: how far work alone explains the time.")
PART_NAMES = {"positions_seconds": "positions", "weights_seconds": "velocities, stored weights",
              "pairs_seconds": "weights and pair sums", "source_seconds": "source"}


def tables(benches):
    """(title, header, rows, note) of every table that has rows; what is read better in a figure is left out."""
    curves = compared(benches)
    found = [("Seconds to reach an error", *reach_table(curves), REACH_NOTE),
             ("Law of cost: seconds and pairs ~ N^a (delta/h)^b", *law_table(curves), LAW_NOTE),
             ("Prices of work", *price_table(curves), PRICE_NOTE),
             ("Threads", *thread_table(benches), "The ratio is of medians of runs that took turns.")]
    return [table for table in found if table[2]]


def left_out(benches):
    """What of the tables is missing, and why, a line each; that a machine was disturbed is one of the lines."""
    curves = compared(benches)
    deviating, timed = work_precision.disturbed([curve for bench in benches for curve in bench.curves])
    lines = []
    if timed >= 10 and deviating > work_precision.DISTURBED * timed:
        lines.append(f"the machine was disturbed: {deviating} of {timed} cases deviate from run to run by more than "
                     f"{100 * work_precision.NOISE:g} %; run make bench again when it does nothing else")
    deviation = f"with a deviation of {100 * work_precision.NOISE:g} % at most"
    few = f"fewer than five cases of {1e3 * work_precision.SHORTEST:g} ms or more {deviation}"
    if curves:
        law, prices = (table[1] for table in (law_table(curves), price_table(curves)))
        of = len(work_precision.costs(curves))
        for name, rows, why in (("the law of cost", law, few), ("the prices of work", prices,
                                                               f"fewer than five cases {deviation}")):
            if len(rows) < of:
                lines.append(f"left out of {name}: {of - len(rows)} of {of} schemes; they have {why}")
    else:
        lines.append("left out: seconds to reach an error, the law of cost, the prices of work; no bench has cases of "
                     "one thread whose errors are compared")
    if not thread_pairs(benches):
        lines.append("left out: threads; no bench has cases with one thread and with several")
    return lines


def page_tables(benches):
    """The same for a page, which has room for all, those of ways to step too."""
    parts = ("Where the time goes, in percent, at the largest N", *parts_table(compared(benches)), "")
    of_ways = ways.tables(benches, Markup("<strong>{}</strong>"), Markup(" / ").join)
    return tables(benches) + ([parts] if parts[2] else []) + of_ways


def compared(benches):
    """The curves whose errors are compared, each once: one thread, no study of scaling, one way to step."""
    found = {}
    for bench in benches:
        for curve in bench.curves:
            if curve.threads == 1 and not ways.stepped(curve) and not any(map(bench_results.is_scaling, curve.studies)):
                found.setdefault(_but_studies(curve), curve)
    return list(found.values())


def _but_studies(curve):
    return (curve.scheme, curve.path, curve.delta_text, curve.source, curve.step_text, curve.integrator, curve.scene,
            curve.T)


def labels(curves):
    """What each curve is called but for its path: its scheme, with the steps where those of one scheme differ."""
    schemes = names.scheme_names(curve.scheme for curve in curves)
    steps = {}
    for curve in curves:
        steps.setdefault(curve.scheme, set()).add(curve.step_text)
    return [schemes[curve.scheme] + (f", step {curve.step_text}" if len(steps[curve.scheme]) > 1 else "")
            for curve in curves]


def reach_table(curves):
    rows = []
    for curve, label in zip(curves, labels(curves)):
        if not len(curve):
            continue
        found = [work_precision.reach(curve, target) for target in work_precision.TARGETS]
        rows.append((label, curve.path, f"{curve.N[0]} – {curve.N[-1]}", f"{curve.error[-1]:.1e}",
                     *(KINDS[one.kind].format(seconds(one.seconds)) for one in found)))
    targets = map(work_precision.target_text, work_precision.TARGETS)
    return ("scheme", "path", "N", "finest error", *targets), rows


def law_table(curves):
    rows = []
    texts = dict(zip(((curve.scheme, curve.step_text) for curve in curves), labels(curves)))
    for key, cost in work_precision.costs(curves).items():
        law, of_pairs = cost.seconds, cost.pairs
        if law and of_pairs:
            rows.append((texts[key], exponent(law.a, law.a_interval), exponent(law.b, law.b_interval),
                         f"{100 * law.rms:.0f} %", f"{law.cases}", f"{law.left_out}",
                         exponent(of_pairs.a, of_pairs.a_interval), exponent(of_pairs.b, of_pairs.b_interval)))
    return ("scheme", "a, seconds", "b, seconds", "rms", "cases", "left out", "a, pairs", "b, pairs"), rows


def price_table(curves):
    texts = dict(zip(((curve.scheme, curve.step_text) for curve in curves), labels(curves)))
    rows = [(texts[key], f"{1e3 * cost.prices.setup:.2g}", f"{1e9 * cost.prices.per_update:.2g}",
             f"{1e9 * cost.prices.per_pair:.2g}", f"{100 * cost.prices.rms:.0f} %")
            for key, cost in work_precision.costs(curves).items() if cost.prices]
    return ("scheme", "set-up (ms)", "ns per update", "ns per pair", "rms"), rows


def parts_table(curves):
    rows = [(label, curve.path, f"{curve.N[-1]}", *(f"{100 * share:.0f}" for share in shares(curve).values()))
            for curve, label in zip(curves, labels(curves)) if len(curve) and math.isfinite(curve.seconds.median[-1])]
    return ("scheme", "path", "N", *PART_NAMES.values(), "rest"), rows


def shares(curve, i=-1):
    """{part: its share of the time of case i}, of medians; the rest is what no part is timed for."""
    total = curve.seconds.median[i]
    parts = {name: curve.parts[name].median[i] / total for name in bench_results.PARTS}
    return {**parts, "rest": max(0.0, 1.0 - sum(parts.values()))}


def thread_table(benches):
    rows = []
    for one, several in thread_pairs(benches):
        label = names.full_name(one.scheme)
        for i in range(len(one)):
            rows.append((label, one.path, f"{one.N[i]}", f"{several.threads}", timing(one, i), timing(several, i),
                         f"{one.seconds.median[i] / several.seconds.median[i]:.2f}"))
    return ("scheme", "path", "N", "threads", "seconds with one", "seconds with several", "ratio"), rows


def thread_pairs(benches):
    """(curve of one thread, the same of several), both of one bench, with the same cases."""
    found = []
    for bench in benches:
        alone = {_but_threads(curve): curve for curve in bench.curves if curve.threads == 1}
        for curve in bench.curves:
            one = alone.get(_but_threads(curve))
            if curve.threads > 1 and one is not None and list(one.N) == list(curve.N):
                found.append((one, curve))
    return found


def _but_threads(curve):
    return curve.studies, curve.scheme, curve.path, curve.source, curve.step_text, curve.integrator, curve.stepping


def timing(curve, i):
    return f"{seconds(curve.seconds.median[i])} ± {seconds(curve.seconds.deviation[i])}"


def exponent(value, interval):
    return f"{value:.2f} [{interval[0]:.2f}, {interval[1]:.2f}]"
