"""Whether 95 % of the reported intervals contain the true order: measured on synthetic series."""

import math

import numpy as np

from drawing import hover
from drawing.look import COLORS, DASHES, GRAY, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from kinds import says
from kinds.kind import Kind
from reading import names


def drawings(study, styles):
    found = [finding for finding in study.findings if finding.test == "bounds" and len(finding.points)]
    if not found:
        return []
    return [Drawing(
        study.name, study.title, coverage_figure(found),
        f"Share of the 95 % intervals that contain the true order, by number of levels, for {study.title}. "
        "Values: table below.",
        "Share of the reported 95 % intervals that contain the true order; error bars: 95 % of a binomial count "
        "(Wilson). The shaded band is demanded; a negative control (pale) must leave it.",
        says=says.share(np.concatenate([finding.points.value for finding in found if not finding.control] or [[]]),
                        "of the reported 95 % intervals contain the true order"))]


def coverage_figure(found):
    """Coverage against the number of levels, a curve per finding; findings over all levels at the right."""
    with typography():
        left, width, tall, foot = 0.78, 5.0, 3.4, 0.6 + LINE * 1.5 * math.ceil(len(found) / 2)
        figure = blank(0.12 + tall + foot)
        panel = add_axes(figure, left, foot, width, tall, follows=True)
        beside = add_axes(figure, left + width + 0.15, foot, WIDTH - left - width - 0.25, tall, sharey=panel,
                          follows=True)
        of_levels = [finding for finding in found if np.all(finding.points.variable > 0)]
        alone = [finding for finding in found if finding not in of_levels]
        lower, upper = found[0].points.lower[0], found[0].points.upper[0]
        lowest = lower
        for one in (panel, beside):
            one.axhspan(lower, upper, color="#DCE9F3", linewidth=0)
            one.axhline(0.95, color=GRAY, linewidth=0.8)
        handles = []
        for i, finding in enumerate(found):
            share, trials = finding.points.value, finding.points.N
            low, high = wilson(share, trials)
            lowest = min(lowest, np.nanmin(low, initial=1.0))
            x, where = (finding.points.variable, panel) if finding in of_levels else ([alone.index(finding)], beside)
            shift = 0.06 * (of_levels.index(finding) - (len(of_levels) - 1) / 2) if finding in of_levels else 0.0
            color = COLORS[i % len(COLORS)]
            handles.append(where.errorbar(
                np.asarray(x) + shift, share, yerr=np.clip([share - low, high - share], 0, None), color=color,
                marker=MARKERS[i % len(MARKERS)], linestyle=DASHES[i % len(DASHES)], linewidth=1.1, capsize=2,
                elinewidth=0.9, markerfacecolor="none" if finding.control else color))
            hover.mark(handles[-1], _name(finding), finding.verdict, share=share,
                       **{"95 % from": low, "to": high, "series": trials})
        levels = sorted({int(x) for finding in of_levels for x in finding.points.variable})
        panel.set_xticks(levels, [f"{level}" for level in levels])
        panel.set_xlabel("levels of a series")
        panel.set_ylabel("share that contains the true order")
        panel.set_ylim(max(0.0, lowest - 0.02), 1.0)
        beside.set(xlim=(-0.6, max(len(alone), 1) - 0.4), xticks=[])
        beside.set_xlabel("all levels together")
        beside.tick_params(labelleft=False)
        texts = list(map(_name, found))
        hover.mark_legend(foot_legend(figure, left, handles, map(names.literal, texts), 2, bottom=0.12), texts)
        return figure


def _name(finding):
    return f"{finding.subject}, {finding.check}"


def wilson(share, trials):
    """The 95 % interval of a share counted in `trials`, by Wilson's score: right also next to 0 and 1."""
    z = 1.959964
    with np.errstate(divide="ignore", invalid="ignore"):
        center = (share + z ** 2 / (2 * trials)) / (1 + z ** 2 / trials)
        half = z / (1 + z ** 2 / trials) * np.sqrt(share * (1 - share) / trials + z ** 2 / (4 * trials ** 2))
    return center - half, center + half


KIND = Kind(drawings)
