"""How often the judge is firm and wrong, and how often it decides: measured on series of two terms."""

import numpy as np

from kinds.coverage import wilson
from drawing import hover
from drawing.look import COLORS, DASHES, GRAY, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from kinds.kind import Kind

FALSE, DECIDED = "false firm verdicts", "decided verdicts"


def drawings(study, styles):
    curves = [finding for finding in study.findings if finding.subject in (FALSE, DECIDED) and len(finding.points) > 1]
    sums = {finding.subject: finding for finding in study.findings
            if finding.subject in (FALSE, DECIDED) and len(finding.points) == 1}
    if not curves or len(sums) < 2:
        return []
    total = sums[FALSE].points.value[0]
    share = sums[DECIDED].points.value[0]
    return [Drawing(
        study.name, study.title, scan_figure(curves, sums),
        f"Shares of false firm verdicts and of decided ones by number of levels, for {study.title}. Values: table below.",
        f"Left: verdicts that pass what departs or condemn what holds, {1000 * total:.2f} in 1,000 of all; the line is what "
        f"may be. Right: verdicts that are not inconclusive where the last pairwise order shows the truth, {100 * share:.1f} % "
        "of all; the line is what is demanded. Error bars: 95 % of a binomial count (Wilson).",
        says=f"{1000 * total:.2f} in 1,000 verdicts are firm and false; where the truth shows, {100 * share:.1f} % decide.")]


def scan_figure(curves, sums):
    """A panel for each of the two shares: over the number of levels, a curve per printing; dashed: of all."""
    with typography():
        left, gap, tall, foot = 0.72, 0.85, 3.0, 0.6 + 1.5 * LINE
        width = (WIDTH - left - gap - 0.15) / 2
        figure = blank(0.15 + tall + foot)
        handles = []
        for i, (subject, factor, label) in enumerate(((FALSE, 1000.0, "false firm verdicts in 1,000"),
                                                      (DECIDED, 100.0, "decided verdicts (%)"))):
            panel = add_axes(figure, left + i * (width + gap), foot, width, tall, follows=True)
            whole = sums[subject].points
            bound = whole.upper[0] if np.isfinite(whole.upper[0]) else whole.lower[0]
            panel.axhline(factor * bound, color=GRAY, linewidth=0.9)
            handles = [panel.axhline(factor * whole.value[0], color="black", linewidth=0.9, linestyle=(0, (4, 3)))]
            found = [finding for finding in curves if finding.subject == subject]
            for k, finding in enumerate(found):
                value, count = finding.points.value, finding.points.N
                low, high = wilson(value, count)
                handles.append(panel.errorbar(
                    finding.points.variable + 0.08 * (k - 1.5), factor * value,
                    yerr=factor * np.clip([value - low, high - value], 0, None), color=COLORS[k],
                    marker=MARKERS[k], linestyle=DASHES[k], linewidth=1.1, capsize=2, elinewidth=0.9))
                hover.mark(handles[-1], finding.check, finding.verdict,
                           **{label: factor * value, "95 % from": factor * low, "to": factor * high, "series": count})
            panel.set_xlabel("levels of a series")
            panel.set_ylabel(label)
            if subject == FALSE:
                panel.set_ylim(bottom=0.0)
        checks = [finding.check for finding in found]
        hover.mark_legend(foot_legend(figure, left, handles, ["all", *checks], 5), [None, *checks])
        return figure


KIND = Kind(drawings)
