"""The detection matrix: which check notices which wrong scheme, and whether any accuses a true one."""

import textwrap

from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from drawing.look import COLORS, DEPARTING, GRAY, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from kinds.kind import Kind
from reading import names
from writing import markup

QUIET, ALARM = "#EDF0F3", COLORS[0]
COUNT = "alarms"        # the check that counts a subject's alarms; no column of its own
SHORT = {"violated": "viol.", "stagnates": "stagn.", "diverges": "div.", "unstable": "unst.", "inconclusive": "incon.",
         "pre-asymptotic": "pre-as."}
ROW, HEAD_ROOM, FOOT = 0.25, 0.12, 0.55     # inches


def drawings(study, styles):
    found = [finding for finding in study.findings if finding.check != COUNT]
    if not found:
        return []
    return [Drawing(
        study.name, study.title, matrix(found),
        f"Matrix of {study.title}: rows are schemes, the true ones first, columns are checks. A filled cell is an "
        "alarm. Values: table below.",
        "Filled: the check raises an alarm, with its verdict. Outlined in red: an alarm where none is expected, or "
        "none where one is. A true scheme must have no alarm, a wrong one at least one.", says=_held_to(study))]


def rows_and_columns(found):
    """(subjects, checks) in order of appearance, subjects that must raise no alarm first."""
    wrong = {finding.subject for finding in found if finding.control}
    subjects = sorted(dict.fromkeys(finding.subject for finding in found), key=lambda subject: subject in wrong)
    return subjects, list(dict.fromkeys(finding.check for finding in found))


def matrix(found):
    """The figure; a cell that several findings share is an alarm if one of them is."""
    subjects, checks = rows_and_columns(found)
    wrong = {finding.subject for finding in found if finding.control}
    with typography():
        labels = [textwrap.fill(names.literal(subject), 46, break_on_hyphens=False) for subject in subjects]
        longest = max(len(line) for label in labels for line in label.split("\n"))
        left = 0.3 + 0.064 * longest
        # The slanted heads reach over the right end.
        cell = min(0.8, (WIDTH - left - 0.95) / len(checks))
        tall = [ROW * max(1, 0.62 * (label.count("\n") + 1)) for label in labels]
        true = sum(subject not in wrong for subject in subjects)
        gap = 0.12 if 0 < true < len(subjects) else 0.0
        head = HEAD_ROOM + 0.045 * max(map(len, checks)) + 0.1
        height = sum(tall) + gap
        figure = blank(head + height + FOOT)
        panel = add_axes(figure, left, FOOT, cell * len(checks), height)
        panel.set(xlim=(0, len(checks)), ylim=(height, 0), xticks=[], yticks=[])
        for side in panel.spines.values():
            side.set_visible(False)
        y = 0.0
        for i, (subject, label, size) in enumerate(zip(subjects, labels, tall)):
            y += gap if i == true else 0.0
            panel.annotate(label, (0, y + size / 2), xytext=(-6, 0), textcoords="offset points", ha="right",
                           va="center", fontsize=9, annotation_clip=False, linespacing=1.0)
            for j, check in enumerate(checks):
                _cell(panel, j, y, size, cell, [one for one in found if (one.subject, one.check) == (subject, check)])
            alarms = sum(any(one.alarm for one in found if (one.subject, one.check) == (subject, check))
                         for check in checks)
            panel.annotate(str(alarms), (len(checks), y + size / 2), xytext=(12, 0), textcoords="offset points",
                           ha="center", va="center", fontsize=9, annotation_clip=False, color=GRAY)
            y += size
        for j, check in enumerate((*checks, "number of alarms")):
            panel.annotate(names.literal(check), (j + 0.42 if j < len(checks) else j + 0.12 / cell, 0), xytext=(0, 4),
                           textcoords="offset points", rotation=60, rotation_mode="anchor", ha="left", va="bottom",
                           fontsize=9, annotation_clip=False, color="black" if j < len(checks) else GRAY)
        keys = {"alarm": Patch(facecolor=ALARM), "quiet": Patch(facecolor=QUIET),
                "not as expected": Patch(facecolor="none", edgecolor=DEPARTING, linewidth=2)}
        if len(found) < len(subjects) * len(checks):
            keys["not examined"] = Line2D([], [], linestyle="none", marker="_", color=GRAY)
        foot_legend(figure, left, keys.values(), keys.keys(), len(keys), bottom=0.12, handlelength=1.6)
        return figure


def _cell(panel, j, y, size, cell, found):
    pad_x, pad_y = 0.025 / cell, 0.02
    if not found:
        panel.text(j + 0.5, y + size / 2, "–", ha="center", va="center", fontsize=8, color=GRAY)
        return
    alarm = next((one for one in found if one.alarm), None)
    panel.add_patch(Rectangle((j + pad_x, y + pad_y), 1 - 2 * pad_x, size - 2 * pad_y, linewidth=0,
                              facecolor=ALARM if alarm else QUIET))
    if alarm:
        text = alarm.verdict if cell >= 0.062 * len(alarm.verdict) else SHORT.get(alarm.verdict, alarm.verdict)
        panel.text(j + 0.5, y + size / 2, text, ha="center", va="center_baseline", fontsize=8, color="white")
    if not all(one.as_expected for one in found):
        panel.add_patch(Rectangle((j + pad_x, y + pad_y), 1 - 2 * pad_x, size - 2 * pad_y, linewidth=2, fill=False,
                                  edgecolor=DEPARTING, zorder=5))


def _held_to(study):
    right = sum(finding.as_expected for finding in study.findings)
    wrong = {finding.subject for finding in study.findings if finding.control}
    accused = {finding.subject for finding in study.findings if finding.alarm}
    return (f"{len(accused & wrong)} of {markup.several(len(wrong), 'wrong scheme')} and {len(accused - wrong)} true ones "
            f"raise an alarm; {right} of {len(study.findings)} cells are as expected.")


KIND = Kind(drawings, held_to=_held_to)
