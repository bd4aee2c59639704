"""Several runs side by side, a column each: which verdicts changed, which orders and errors, and from where the runs are."""

from collections import Counter
from dataclasses import dataclass
import math

from markupsafe import Markup

from reading import history, names
from writing import markup, tables

MOST = 30                   # rows of numbers that changed; all of them stand below their studies
FILE = "history.html"       # in the folder of the last run
_LINK, _NAV_ENDS = f'<a href="{FILE}">Earlier runs</a>', "</nav>"
SAID = {history.WORSENED: "worsened", history.IMPROVED: "improved", history.VERDICT: "other verdict",
        history.MISSING: "not in each run", history.NUMBERS: "other numbers", history.SAME: "the same"}
# Where these differ, numbers may.
DECIDING = ("numerics", "compiler", "flags", "libraries", "machine", "vectors", "system")
ORIGINS = ("version", *DECIDING, "created", "command")


@dataclass(frozen=True)
class Run:
    """The studies of a folder of results."""
    name: str           # of the folder, as it was given
    studies: tuple


@dataclass(frozen=True)
class Part:
    """A part of the page."""
    anchor: str
    title: str
    asks: str
    content: Markup


def linked(page):
    """The text of a page of the same folder, with a link to this one in its first navigation."""
    return page if _LINK in page else page.replace(_NAV_ENDS, _LINK + _NAV_ENDS, 1)


def html(runs):
    """The page as text. runs: oldest first."""
    found = sorted(history.lines([run.studies for run in runs]), key=lambda line: history.CHANGES.index(line.change))
    counts = Counter(line.change for line in found)
    verdicts = [line for line in found if line.change in (history.WORSENED, history.IMPROVED, history.VERDICT,
                                                          history.MISSING)]
    numbers = sorted((line for line in found if line.change == history.NUMBERS), key=_distance, reverse=True)
    parts = [Part("verdicts", "Verdicts that changed", "Which verdicts are not the same in each run?",
                  _table("Verdicts that changed", runs, verdicts)),
             Part("numbers", "Numbers that changed", "Where verdicts are the same: which orders and errors are not?",
                  _table("Numbers that changed", runs, numbers[:MOST]) + _more(len(numbers) - MOST)),
             Part("all", "Study by study", "What did each run find?", _by_study(runs, found)),
             Part("runs", "Provenance", "Which sources, compilers and machines are the runs from?",
                  _origins(runs, counts))]
    return str(markup.render("history.html", title=f"{markup.several(len(runs), 'run')} side by side",
                             style=markup.style(), faces="", script=markup.script(),
                             runs=runs, bad=bool(counts[history.WORSENED]),
                             said=_said(counts), parts=[part for part in parts if part.content]))


def _more(count):
    return Markup("<p>{} more below their studies.</p>\n").format(count) if count > 0 else ""


def _said(counts):
    """What changed, in a sentence."""
    changes = [f"{counts[change]} {SAID[change]}" for change in history.CHANGES if counts[change]]
    total = sum(counts.values())
    if counts[history.SAME] == total:
        return f"Nothing has changed in {markup.several(total, 'verdict')} and their numbers"
    return f"Of {markup.several(total, 'verdict')}: {', '.join(changes)}"


def _distance(line):
    """How far the numbers of a line are apart."""
    low, high = line.errors
    return math.inf if math.isnan(low) else max(-math.log(low), math.log(high))


def _table(label, runs, lines):
    if not lines:
        return Markup()
    columns = ("~study and finding", "change", *(f"~{run.name}" for run in runs), "#errors, last to first",
               "#pairs", "#seconds")
    return Markup(tables.table(label, columns, [_row(line) for line in lines]))


def _row(line):
    return tables.Row((Markup("{}<br>{}").format(line.study, markup.note("; ".join(filter(None, (line.subject, line.check))))),
                       SAID[line.change], *map(_cell, line.findings), _range(*line.errors), _ratio(line.pairs),
                       _ratio(line.seconds, exact=False)), line.change == history.WORSENED)


def _cell(finding):
    """Verdict and order of a run."""
    if finding is None:
        return "–"
    order = ""
    if math.isfinite(finding.observed_order):
        order = "{} [{}, {}]".format(*map(names.order, (finding.observed_order, finding.observed_low,
                                                        finding.observed_high)))
    expected = "" if finding.as_expected else f"expected {finding.expected}"
    return markup.joined(filter(None, (markup.badge(finding, finding.control), order, markup.note(expected))), markup.BAR)


def _range(low, high):
    if math.isnan(low):
        return "–"
    if low == high == 1.0:
        return "equal"
    return _ratio(low) if low == high else f"{_ratio(low)} to {_ratio(high)}"


def _ratio(ratio, exact=True):
    """exact: 1 says equal to the last bit."""
    if not math.isfinite(ratio):
        return "–"
    beyond = ratio - 1.0
    if exact and 0.0 < abs(beyond) < 1e-3:
        return f"1 {'+' if beyond > 0 else '−'} {abs(beyond):.0e}".replace("e-0", "e-")
    return f"{ratio:.3g}"


def _by_study(runs, found):
    by_name = {}
    for line in found:
        by_name.setdefault(line.study, []).append(line)
    return markup.joined(_study(runs, name, by_name[name]) for name in sorted(by_name))


def _study(runs, name, lines):
    counts = Counter(line.change for line in lines)
    said = Markup("{} {}").format(name, markup.note(_said(counts)))
    return tables.fold(said, _table(name, runs, lines), anchor=name)


def _origins(runs, counts):
    """A row per entry of the provenance, a column per run; those that differ are marked."""
    rows = [tables.Row(("studies", *(f"{len(run.studies)}" for run in runs)))]
    for entry in ORIGINS:
        values = [sorted({study.provenance.get(entry, "unknown") for study in run.studies}) for run in runs]
        differs = entry in DECIDING and len({tuple(one) for one in values}) > 1
        heading = Markup("<strong>{}</strong> {}").format(entry, markup.note("differs")) if differs else entry
        rows.append(tables.Row((heading, *(_values(one) for one in values))))
    causes = [entry for entry in DECIDING
              if len({study.provenance.get(entry, "unknown") for run in runs for study in run.studies}) > 1]
    said = ""
    if any(count for change, count in counts.items() if change not in (history.SAME, history.MISSING)):
        said = (f"Runs are deterministic: numbers differ because of {', '.join(causes)}, or of the study files." if causes
                else "Nothing that decides a run differs, and runs are deterministic: the study files differ, or the "
                     "sources that measure and judge, or a file was changed.")
    return Markup("<p>{}</p>\n{}").format(
        said, tables.table("Provenance", ("of", *(f"~{run.name}" for run in runs)), rows))


def _values(found):
    return found[0] if len(found) == 1 else f"{found[0]} … {found[-1]} ({len(found)} different ones)" if found else "–"
