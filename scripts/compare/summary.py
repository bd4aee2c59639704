"""What the runs say: whether errors agree, how many times slower than acstudy each program is, and the tables of it."""

from statistics import median

TOLERANCE = 1e-9    # relative, of an error: round-off of some 1000 steps in another order
BASE = "acstudy"    # the program that the others are compared with, on one thread
NONE = "–"


def disagreements(cases, program, outcome):
    """A line per case whose error is not that of acstudy; NaN never is."""
    lines = []
    for case, result in zip(cases, outcome.cases):
        if result and not abs(result[0] - case.error_linf) <= TOLERANCE * abs(case.error_linf):
            lines.append(f"{program.name}: {describe(case)}: error {result[0]:.17g}, but {case.error_linf:.17g} by "
                         "acstudy")
    return lines


def describe(case):
    moving = "" if case.scene == "standing" else f", {case.divergence} divergence"
    return f"Model {'I' * case.model}, {case.kernel}{moving}, {case.path}, N = {case.N}"


# ------------------------------------------------------------------------------------------------------------- ratios

def spread(values):
    return {"median": median(values), "low": min(values), "high": max(values)}


def ratios(times, base_times):
    """Of one round by round: what slows the machine down for a while slows both."""
    return spread([seconds / base for seconds, base in zip(times, base_times)])


def loop_times(rounds, name, keys):
    """Seconds of the time loops of some cases, of each round; None if one of them was left out."""
    each = [round_[name]["cases"] for round_ in rounds]
    if any(one.get(key) is None for one in each for key in keys):
        return None
    return [sum(one[key]["seconds"] for key in keys) for one in each]


def summarize(cases, programs, rounds):
    """The summary of a comparison, as it is stored.

    @param programs  entries with name, label, version, missing, loops
    @param rounds    {program: {"process_seconds", "cases": {index: {"error_linf", "seconds"}}}} of each round
    """
    everything = range(len(cases))
    rows, base_process = [], [round_[BASE]["process_seconds"] for round_ in rounds]
    threads = [program["name"] for program in programs if not program["loops"] and not program["missing"]]
    for program in programs:
        if program["missing"]:
            continue
        name = program["name"]
        done = [i for i in everything if all(round_[name]["cases"].get(i) for round_ in rounds)]
        process = [round_[name]["process_seconds"] for round_ in rounds]
        loops = loop_times(rounds, name, done) if program["loops"] and done else None
        of_all = len(done) == len(cases)
        rows.append({
            "name": name, "label": program["label"], "version": program["version"], "cases": len(done),
            "loop_seconds": median(loops) if loops else None, "process_seconds": median(process),
            "loop_ratio": ratios(loops, loop_times(rounds, BASE, done)) if loops else None,
            "process_ratio": ratios(process, base_process) if of_all else None,
            "threads_ratio": ratios(process, [round_[threads[0]]["process_seconds"] for round_ in rounds])
                             if of_all and threads else None})
    return {"programs": rows, "groups": group_rows(cases, rows, rounds)}


def group_rows(cases, rows, rounds):
    """The ratios of each scheme, kernel, path and N, both divergences together."""
    groups = {}
    for i, case in enumerate(cases):
        groups.setdefault((case.scene, case.model, case.kernel, case.path, case.N), []).append(i)
    found = []
    for (scene, model, kernel, path, N), members in groups.items():
        found.append({"scene": scene, "model": model, "kernel": kernel, "path": path, "N": N,
                      "seconds": median(loop_times(rounds, BASE, members)), "ratios": {}})
        for row in rows:
            times = loop_times(rounds, row["name"], members)
            if row["name"] != BASE and row["loop_seconds"] is not None and times:
                found[-1]["ratios"][row["name"]] = ratios(times, loop_times(rounds, BASE, members))
    return found


# ------------------------------------------------------------------------------------------------------------- tables

def said_ratio(ratio):
    if not ratio:
        return NONE
    middle, low, high = (f"{ratio[name]:.3g}" if ratio[name] < 99.5 else f"{ratio[name]:.0f}"
                         for name in ("median", "low", "high"))
    return f"{middle} ({low} – {high})"


def said_seconds(seconds):
    return NONE if seconds is None else f"{seconds:.3g}" if seconds < 99.5 else f"{seconds:.0f}"


def program_table(summary):
    """(columns, rows) of the programs."""
    threads = any(row["threads_ratio"] for row in summary["programs"])
    columns = ["program", "cases", "time loops (s)", "whole process (s)", "loops, times acstudy",
               "process, times acstudy"] + (["process, times acstudy on all threads"] if threads else [])
    rows = []
    for row in summary["programs"]:
        rows.append([row["label"], str(row["cases"]), said_seconds(row["loop_seconds"]),
                     said_seconds(row["process_seconds"]), said_ratio(row["loop_ratio"]),
                     said_ratio(row["process_ratio"])] + ([said_ratio(row["threads_ratio"])] if threads else []))
    return columns, rows


def group_table(summary):
    """(columns, rows) of schemes, kernels and paths; programs that have no entry get no column."""
    shown = [row for row in summary["programs"] if any(row["name"] in group["ratios"] for group in summary["groups"])]
    columns = ["scheme, kernel, path", "N", "acstudy (s)", *(row["label"] for row in shown)]
    rows = []
    for group in summary["groups"]:
        standing = ", standing" if group["scene"] == "standing" else ""
        rows.append([f"Model {'I' * group['model']}, {group['kernel']}, {group['path']}{standing}", str(group["N"]),
                     said_seconds(group["seconds"]),
                     *(said_ratio(group["ratios"].get(row["name"])) for row in shown)])
    return columns, rows


def markdown(table):
    columns, rows = table
    lines = [columns, ["---"] + ["---:"] * (len(columns) - 1), *rows]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)
