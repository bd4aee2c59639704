"""Which cases are compared: the studies of the figures, cut to some of their levels, and what acstudy makes of them."""

from dataclasses import asdict, dataclass
import json
from pathlib import Path
import re

import strict_json

ROOT = Path(__file__).resolve().parent.parent.parent
STUDIES = {**{f"fig{i}": ROOT / "studies" / f"fig{i}.toml" for i in range(1, 6)},
           "standing": Path(__file__).resolve().parent / "standing.toml"}
PATH = re.compile(r"^\[\[path\]\]$", re.M)
LEVELS = re.compile(r"^N = \[(.*)\]$", re.M)


@dataclass(frozen=True)
class Case:
    """A case and its error by acstudy; what the programs are given, but for `path` and `error_linf`."""
    scene: str          # "lee-du-2019" | "standing"
    model: int
    divergence: str
    kernel: str
    path: str           # its name
    source: str
    N: int
    delta: float
    steps: int
    mu: float           # 0 in Model I
    error_linf: float

    @property
    def key(self):
        return self.scene, self.model, self.divergence, self.kernel, self.source, self.N, self.delta, self.steps

    def asked(self):
        """What a program gets to know: not the error."""
        return {name: value for name, value in asdict(self).items() if name not in ("error_linf", "path")}


def coarsest(levels, _):
    return levels[:1]


def representative(levels, nonlocal_source):
    """The second finest level; where the source is nonlocal the coarsest too, for adaptive quadrature."""
    return sorted({levels[-2], *(levels[:1] if nonlocal_source else ())})


def every(levels, _):
    return levels


def cut_study(text, choose):
    """The text of a study with those levels of each path that `choose` takes.

    @param choose  of the levels of a path, and whether its source is nonlocal
    """
    head, *paths = PATH.split(text)
    parts = [head]
    for path in paths:
        found = LEVELS.search(path)
        chosen = choose(sorted(map(int, found[1].split(","))), 'source = "nonlocal"' in path)
        parts.append("[[path]]" + LEVELS.sub(f"N = {list(chosen)}", path))
    return "".join(parts)


def write_studies(names, choose, folder):
    """The files of the cut studies."""
    files = []
    for name in names:
        files.append(folder / f"{name}.toml")
        files[-1].write_text(cut_study(STUDIES[name].read_text(encoding="utf-8"), choose), encoding="utf-8")
    return files


def read_results(names, folder):
    """{key: (Case, seconds)} of the distinct cases in acstudy's result files."""
    found = {}
    for name in names:
        for series in json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))["series"]:
            for one in series["cases"]:
                case = Case("standing" if name == "standing" else "lee-du-2019", series["model"], series["divergence"],
                            series["kernel"], series["path"], series["source"], one["N"], one["delta"], one["steps"],
                            series.get("mu", 0.0), strict_json.number(one["error_linf"]))
                found.setdefault(case.key, (case, one["seconds"]))
    return found
