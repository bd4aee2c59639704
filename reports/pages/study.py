"""The part of the page about a study: what came out, and everything needed to doubt it."""

import shlex

from kinds import registry
from writing import markup


def article(study, drawings):
    """`drawings`: those that are not shown elsewhere."""
    shown = registry.of(study).section(study, drawings, registry.entries(study))
    return markup.render("study.html", study=study, body=shown, origin=origin(study))


def origin(study):
    """What the study asked for, what made its numbers, and the command that does so again."""
    scene = {} if study.scene is None else {
        "name": study.scene.name, "period": f"{study.scene.period:.10g}", "T": f"{study.scene.T:.10g}",
        "advection velocity c": study.scene.c, "particle velocity b": study.scene.b or "none: particles stand still",
        **({"exact solution u": study.scene.u} if study.scene.u else
           {"initial values u0": study.scene.u0, "source f": study.scene.f or "0"}), "flow": study.scene.flow or "none given"}
    return markup.render("origin.html", scene=listing(scene), text=study.text, provenance=listing(study.provenance),
                         command=again(study))


def listing(entries):
    return markup.render("listing.html", entries=entries) if entries else ""


def again(study):
    """The command that makes this study's results and the page again."""
    words = shlex.split(study.provenance.get("command", "")) or ["acstudy"]
    file = next((word for word in words if word.endswith(f"{study.name}.toml")), f"{study.name}.toml")
    out = study.file.parent
    return f"{words[0]} run {file} --out {out} && python3 reports/report.py {out}"
