"""Scenes that were stepped in several ways: seconds to reach an error, and what a step costs, way by way."""

from dataclasses import dataclass

import numpy as np

from kinds.bench.texts import seconds
from reading import names, work_precision
from reading.bench_results import Spread

# Errors of solutions of size 1; one that no way reaches on any scene is left out.
TARGETS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3)
EXPLICIT = "forward-euler, by the lemma"    # what costs are compared to
BLOWN = "blows up"
REACH_NOTE = ("Of each way the quickest run, whatever its N, step or tolerance, by power laws between neighboring runs that "
              "no other run of the way beats; {best}: the quickest way. `<`: already the roughest run is better, in this "
              "time. –: not reached. Errors are of solutions of size 1.")
COST_NOTE = ("Nanoseconds per particle and step at the largest N, all of the run in them; in brackets how many times those "
             "of forward Euler's steps by the lemma.")


@dataclass(frozen=True, eq=False)
class Way:
    """All runs of a scheme along one path in one way to step: arrays [n]. NaN: a run that blew up."""
    name: str
    said: tuple             # of each run: its step or tolerance
    N: np.ndarray
    steps: np.ndarray
    error: np.ndarray
    seconds: Spread

    def chosen(self, which):
        spread = Spread(*(of[which] for of in (self.seconds.median, self.seconds.minimum, self.seconds.deviation)))
        return Way(self.name, tuple(np.array(self.said, dtype=object)[which]), self.N[which], self.steps[which],
                   self.error[which], spread)

    def efficient(self):
        """The runs that no other one beats, from the quickest on."""
        which = np.flatnonzero(work_precision.frontier(self.seconds.median, self.error))
        return self.chosen(which[np.argsort(self.seconds.median[which])])

    def blows_up(self):
        return not np.any(np.isfinite(self.error))


def scenes(benches):
    """{title of a study: {(path, scheme): {name of a way: Way}}} of the studies of benches that step in several ways."""
    found = {}
    for bench in benches:
        for curve in bench.curves:
            if stepped(curve):
                group = found.setdefault(curve.title, {}).setdefault((curve.path, curve.scheme), {})
                group.setdefault(way_of(curve), []).append(curve)
    return {title: {of: {name: _way(name, curves) for name, curves in ways.items()} for of, ways in groups.items()}
            for title, groups in found.items()}


def stepped(curve):
    """Whether a curve is one of several ways to step."""
    return curve.threads == 1 and bool(curve.stepping)


def way_of(curve):
    """How it steps, whatever the length of equal steps or the tolerance of adaptive ones."""
    text = curve.step_text
    rule = ("adaptive" if text.startswith("adaptive") else "by rows" if text.endswith("by rows") else
            "by the lemma" if text.endswith("cfl") else "equal steps")
    return f"{curve.integrator}, {rule}"


def _way(name, curves):
    def joined(of):
        return np.concatenate([of(curve) for curve in curves])

    return Way(name, tuple(curve.step_text for curve in curves for _ in range(len(curve))), joined(lambda c: c.N),
               joined(lambda c: c.steps), joined(lambda c: c.error),
               Spread(*(joined(lambda c, part=part: getattr(c.seconds, part))
                        for part in ("median", "minimum", "deviation"))))


def reach(way, target):
    """Seconds to an error of `target`; nothing is extrapolated, for N may be the same in all runs."""
    efficient = way.efficient()
    if not np.any(efficient.error <= target):
        return work_precision.Reach("not", np.nan)
    return work_precision.reach(efficient, target)


def tables(benches, best="**{}**", join=" / ".join):
    """(title, header, rows, note) of every table. best: how the quickest way is marked; join: of schemes in a cell."""
    every = scenes(benches)
    targets = [target for target in TARGETS if any(
        np.isfinite(reach(way, target).seconds) for groups in every.values() for ways in groups.values()
        for way in ways.values())]
    found = [(f"{title}: seconds to reach an error", *_reach_table(groups, targets, best, join),
              REACH_NOTE.format(best=best.format("marked")) + f" In a cell: {_schemes_said(groups)}.")
             for title, groups in every.items()]
    costs = ("What a step costs", *_cost_table(every), COST_NOTE)
    return [table for table in [*found, costs] if table[2]]


def _schemes_said(groups):
    return " / ".join(map(names.model, dict.fromkeys(scheme for _, scheme in groups)))


def _reach_table(groups, targets, best, join):
    """A row per way, a column per path and error."""
    paths, schemes = (list(dict.fromkeys(of[i] for of in groups)) for i in (0, 1))
    columns = {}    # (path, target): {scheme: {way: text}}
    for path in paths:
        for target in targets:
            columns[path, target] = {scheme: _marked(groups.get((path, scheme), {}), target, best) for scheme in schemes}
    ways = dict.fromkeys(way for group in groups.values() for way in group)
    rows = [(way, *(join([cells[scheme].get(way, "–") for scheme in schemes]) for cells in columns.values()))
            for way in ways]
    return ("steps", *(f"{path}: {work_precision.target_text(target)}" for path, target in columns)), rows


def _marked(ways, target, best):
    """{name: seconds of a way as text}, the quickest one marked."""
    found = {name: reach(way, target) for name, way in ways.items()}
    least = min((one.seconds for one in found.values() if np.isfinite(one.seconds)), default=np.nan)
    return {name: BLOWN if ways[name].blows_up() else
            (best if one.seconds == least else "{}").format(_REACHED[one.kind].format(seconds(one.seconds)))
            for name, one in found.items()}


_REACHED = {"between": "{}", "coarsest": "< {}", "not": "–"}


def _cost_table(every):
    """A row per scene, path and scheme, a column per way whose steps all are of the same kind."""
    names_of_ways = (name for groups in every.values() for ways in groups.values() for name in ways)
    shown = [name for name in dict.fromkeys(names_of_ways) if not name.endswith("adaptive")]
    rows = []
    for title, groups in every.items():
        for (path, scheme), ways in groups.items():
            if EXPLICIT in ways:
                per_step = {name: per_particle_and_step(way) for name, way in ways.items()}
                rows.append((title, path, names.model(scheme), f"{max(ways[EXPLICIT].N)}",
                             *(_ratio(per_step.get(name, np.nan), per_step[EXPLICIT]) for name in shown)))
    return ("scene", "path", "scheme", "N", *shown), rows


def per_particle_and_step(way):
    """Nanoseconds, of the run with the most steps at the largest N; NaN where none came to its end."""
    run = way.chosen(np.flatnonzero(np.isfinite(way.error) & (way.N == max(way.N))))
    if not len(run.N):
        return np.nan
    i = np.argmax(run.steps)
    return 1e9 * run.seconds.median[i] / (run.N[i] * run.steps[i])


def _ratio(own, other):
    if not np.isfinite(own):
        return BLOWN
    return f"{own:.3g}" if own == other else f"{own:.3g} ({own / other:.2g})"
