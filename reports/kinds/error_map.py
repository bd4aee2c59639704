"""The plane of horizon and spacing: a map of the error for every scheme and target, and cuts through it."""

from functools import partial
import math
import textwrap

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.lines import Line2D
from matplotlib.patheffects import Stroke, Normal
import matplotlib
import numpy as np

from drawing import axes, hover
from drawing.look import COLORS, DASHES, GRAY, LINE, MARKERS, WIDTH, Drawing, add_axes, blank, foot_legend, typography
from kinds.kind import Kind
from reading import names

# Refinement paths: name, horizon at spacing h, dashes.
PATHS = ((r"$\delta=4h$", lambda h: 4 * h, "solid"), (r"$\delta=\sqrt{h}$", np.sqrt, (0, (5, 1.6))),
         (r"$\delta=h^2$", lambda h: h ** 2, (0, (1.2, 1.2))),
         (r"$\delta=0.2$", lambda h: 0.2 + 0 * h, (0, (6, 1.4, 1.2, 1.4))))
TARGETS = {"nonlocal": "error against the nonlocal model", "local": "error against the local equation"}


def drawings(study, styles):
    planes = error_planes(study.evidence)
    if not planes:
        return []
    described = "for every scheme against both targets. Values: the result file."
    return [
        Drawing(study.name, study.title, partial(map_figure, study, planes),
                f"Color maps of the max-norm error over spacing h and horizon delta {described}",
                "Max-norm error at the final time over spacing and horizon; both axes and the colors are logarithmic, "
                "dots are the cases, thin lines those of equal error. Thick lines: refinement paths. "
                f"{_fit_caption(study)}Asymptotic compatibility: against the nonlocal model the error falls to the left "
                "at every horizon, against the local equation toward the lower left, however that is approached.",
                says=_map_says(study)),
        Drawing(f"{study.name}.cuts", f"{study.title}: cuts",
                partial(cuts_figure, study.evidence, planes),
                f"Orders in h at fixed horizon, and errors at the finest spacing against the horizon, {described}",
                "Left and middle: order in the limit h → 0 at each horizon, with its 95 % interval, cut at the panel's "
                "edge. Shaded: horizons between the finest and the coarsest spacing. There a cut passes from δ < h to "
                "δ > h, and where δ is close to h parts of the error cancel, also shortly below: no order of a limit "
                "can be read (pale). Right: error at the finest spacing; against the local equation it approaches the "
                "distance of the two solutions, O(δ).", says=_cuts_say(study.evidence, planes))]


def _map_says(study):
    """The orders of the fitted surfaces; "" without any."""
    fits = [finding.fit for finding in study.findings if finding.test == "surface" and finding.fit]
    said = []
    for name, variable in (("p", "h"), ("q", "δ")):
        orders = [fit[name] for fit in fits if math.isfinite(fit.get(name, math.nan))]
        if orders:
            low, high = names.order(min(orders)), names.order(max(orders))
            said.append(f"{name} = {low if low == high else f'{low} to {high}'} in {variable}")
    return f"Over the whole plane the error has the orders {' and '.join(said)}." if said else ""


def _cuts(evidence, scheme, target):
    """(delta, order, its interval) of the cuts at fixed horizon of a scheme; columns of an array, ascending."""
    return np.array(sorted((one.points.delta[0], one.observed_order, one.observed_low, one.observed_high)
                           for one in evidence if (one.series.scheme, one.series.source) == (scheme, target)
                           and len(one.points))).reshape(-1, 4).T


def _between(planes):
    """(finest, coarsest) spacing of all planes."""
    every = np.concatenate([h for h, *_ in planes.values()])
    return every.min(), every.max()


def _cuts_say(evidence, planes):
    """The orders on both sides of the horizons at which cuts pass from δ < h to δ > h."""
    finest, coarsest = _between(planes)
    said = []
    for target, what in TARGETS.items():
        cuts = np.concatenate([_cuts(evidence, *key) for key in planes if key[1] == target] or [np.empty((4, 0))], axis=1)
        for where, text in ((cuts[0] > coarsest, "δ > h at all levels"), (cuts[0] < finest / 4, "δ < h/4 at all levels")):
            orders = cuts[1][where & np.isfinite(cuts[1])]
            if len(orders):
                said.append(f"{what}, {text}: order {names.order(orders.min())} to {names.order(orders.max())}")
    return f"{'; '.join(said)}.".capitalize() if said else ""


def error_planes(evidence):
    """{(scheme, source): (h [n], delta [m], error [m, n])}, ascending; NaN: no case."""
    cases = {}
    for one in evidence:
        of = one.series.cases
        for h, delta, error in zip(of.h, of.delta, of.error_linf):
            cases.setdefault((one.series.scheme, one.series.source), {})[float(f"{h:.9g}"), float(f"{delta:.9g}")] = error
    planes = {}
    for key, found in cases.items():
        h, delta = (np.array(sorted(set(values))) for values in zip(*found))
        error = np.array([[found.get((x, y), math.nan) for x in h] for y in delta])
        planes[key] = h, delta, np.where(np.isfinite(error) & (error > 0), error, math.nan)
    return planes


def map_figure(study, planes):
    """A column per scheme, a row per target; one scale of color."""
    with typography():
        schemes = list(dict.fromkeys(scheme for scheme, _ in planes))
        targets = [target for target in TARGETS if any(source == target for _, source in planes)]
        labels = names.scheme_names(schemes)
        left, right, gap, head, foot = 0.85, 0.95, 0.14, 0.5, 0.9
        titles = {(scheme, target): _fit_text(study, scheme, target) for scheme, target in planes}
        spaces = [0.3 + (0.38 if any(titles.get((scheme, target)) for scheme in schemes) else 0.0)
                  for target in targets]
        width = min(3.0, (WIDTH - left - right - (len(schemes) - 1) * gap) / len(schemes))
        tall = 1.15 * width
        height = len(targets) * (tall + 0.18) + sum(spaces) - 0.18
        figure = blank(head + height + foot)
        total = figure.get_figheight()
        levels = _levels([error for *_, error in planes.values()])
        colors = matplotlib.colormaps["cividis"]
        norm = BoundaryNorm(levels, colors.N)
        for row, target in enumerate(targets):
            bottom = total - head - (row + 1) * tall - row * 0.18 - sum(spaces[:row + 1])
            for column, scheme in enumerate(schemes):
                if (scheme, target) not in planes:
                    continue
                h, delta, error = planes[scheme, target]
                panel = add_axes(figure, left + column * (width + gap), bottom, width, tall, follows=True,
                                 xscale="log", yscale="log")
                panel.contourf(h, delta, np.ma.masked_invalid(error), levels=levels, cmap=colors, norm=norm)
                _label_contours(panel, h, delta, error)
                _paths(panel, h, delta)
                axes.set_log_limits(panel, (h[0], h[-1]), (delta[0], delta[-1]), (width, tall))
                panel.tick_params(which="both", direction="out", labelleft=column == 0,
                                  labelbottom=row == len(targets) - 1)
                panel.set_title(titles[scheme, target], fontsize=9, pad=4)
                if row == 0:
                    panel.annotate(textwrap.fill(labels[scheme], max(14, int(width / 0.078))), (0.5, 1),
                                   xycoords="axes fraction", xytext=(0, 72 * spaces[0]), textcoords="offset points",
                                   ha="center", va="bottom", fontsize=11.5, linespacing=1.0)
                if row == len(targets) - 1:
                    panel.set_xlabel("$h$")
                if column == 0:
                    panel.set_ylabel(r"$\delta$")
                    panel.annotate(TARGETS[target], (0, 1), xycoords="axes fraction", xytext=(0, 72 * spaces[row] - 17),
                                   textcoords="offset points", va="bottom", fontsize=11.5)
        bar = figure.colorbar(ScalarMappable(norm, colors), cax=add_axes(
            figure, left + len(schemes) * (width + gap), foot, 0.16, height - spaces[0], Axes), spacing="proportional")
        ticks = [level for level in levels if abs(math.log10(level) - round(math.log10(level))) < 1e-6] or levels[::3]
        bar.set_ticks(ticks, labels=[axes.tick_text(tick, [1e-9]) for tick in ticks])
        bar.minorticks_off()
        bar.ax.set_yscale("log")
        bar.set_label("max-norm error at $T$")
        foot_legend(figure, left, [Line2D([], [], color="black", linestyle=dash, linewidth=1.2) for *_, dash in PATHS],
                    [name for name, *_ in PATHS], len(PATHS), bottom=0.12)
        return figure


def _levels(errors):
    """Contour levels, eight a decade at most and about twenty in all, a decade among them."""
    values = np.concatenate([error[np.isfinite(error)] for error in errors])
    low, high = (math.log10(values.min()), math.log10(values.max())) if len(values) else (-1.0, 0.0)
    per_decade = max(1, min(8, int(20 / max(high - low, 0.5))))
    first, last = math.floor(low * per_decade), math.ceil(high * per_decade)
    return 10.0 ** (np.arange(first, max(last, first + 1) + 1) / per_decade)


def _label_contours(panel, h, delta, error):
    """Thin lines of equal error, two a decade, with their values."""
    if np.sum(np.isfinite(error)) < 4:
        return
    levels = [float(f"{step}e{power}") for power in range(-12, 2) for step in (1, 3)]
    levels = [level for level in levels if np.nanmin(error) < level < np.nanmax(error)]
    if not levels:
        return
    lines = panel.contour(h, delta, np.ma.masked_invalid(error), levels=levels, colors="white", linewidths=0.8)
    for text in panel.clabel(lines, fontsize=8, inline_spacing=3, colors="black", fmt=lambda level: f"{level:g}"):
        text.set_path_effects([Stroke(linewidth=2.2, foreground="white", alpha=0.75), Normal()])


def _paths(panel, h, delta):
    panel.plot(*(grid.ravel() for grid in np.meshgrid(h, delta)), linestyle="none", marker=".", markersize=1.2,
               color="white", alpha=0.7)
    x = np.geomspace(h[0], h[-1], 200)
    for _, horizon, dash in PATHS:
        y = horizon(x)
        inside = (y >= delta[0]) & (y <= delta[-1])
        if inside.any():
            ends = np.flatnonzero(inside)[[0, -1]]      # every path is straight on these axes
            line, = panel.plot(x[ends], y[ends], color="black", linestyle=dash, linewidth=1.2)
            line.set_path_effects([Stroke(linewidth=2.6, foreground="white", alpha=0.75), Normal()])


def _fit_text(study, scheme, target):
    """Exponents of the fitted surface A h^p + B delta^q, as the result file has them."""
    for finding in study.findings:
        if finding.test == "surface" and finding.subject == names.full_name(scheme) and _target(finding) == target:
            lines = [rf"${name}$ = {names.order(finding.fit[name])} "
                     f"[{names.order(finding.fit.get(f'{name}_low', math.nan))}, "
                     f"{names.order(finding.fit.get(f'{name}_high', math.nan))}]"
                     for name in ("p", "q") if math.isfinite(finding.fit.get(name, math.nan))]
            return "\n".join(lines)
    return ""


def _fit_caption(study):
    """What p and q belong to, and how much better the law describes the errors than a plain sum; "" without a fit."""
    fits = [finding.fit for finding in study.findings if finding.test == "surface" and finding.fit]
    if not fits:
        return ""
    said = ("p and q, with 95 % intervals: orders of error = (a^m + b^m)^(1/m), a = A h^p exp(D h/h_max), "
            "b = B δ^q exp(F δ/δ_max); the sharpness m says how the two terms join, from their sum (m = 1) to the "
            "larger one (m → ∞). ")
    gains = [fit["bic_sum"] - fit["bic"] for fit in fits if math.isfinite(fit.get("bic_sum", math.nan))
             and math.isfinite(fit.get("bic", math.nan))]
    if gains:
        least, most = f"{min(gains):.0f}", f"{max(gains):.0f}"
        more = least if least == most else f"{least} to {most}"
        said += f"The Bayesian information criterion of the plain sum a + b is larger by {more}. ".replace("-", "−")
    return said


def _target(finding):
    return finding.coordinates["source"]


def cuts_figure(evidence, planes):
    with typography():
        schemes = list(dict.fromkeys(scheme for scheme, _ in planes))
        labels = names.scheme_names(schemes)
        left, width, tall, gap, above = 0.62, 2.42, 2.9, 0.12, 0.38
        foot = 0.65 + LINE * 1.5 * math.ceil((len(schemes) + 2) / 2)
        figure = blank(above + tall + foot)
        orders = {target: add_axes(figure, left + i * (width + gap), foot, width, tall, xscale="log")
                  for i, target in enumerate(TARGETS)}
        errors = add_axes(figure, WIDTH - 0.1 - width, foot, width, tall, xscale="log", yscale="log")
        finest, coarsest = _between(planes)
        styles = {}
        for i, scheme in enumerate(schemes):
            filled, color = scheme.divergence != "nonlocal", COLORS[i % len(COLORS)]
            styles[scheme] = dict(color=color, marker=MARKERS[i % len(MARKERS)], linewidth=1.1,
                                  markersize=3.6 if filled else 6.5, markerfacecolor=color if filled else "none")
        for (scheme, target), (h, delta, error) in planes.items():
            dash = DASHES[1] if target == "local" else "solid"
            curve, = errors.plot(delta, error[:, 0], linestyle=dash, **styles[scheme])
            hover.mark(curve, labels[scheme], TARGETS[target], δ=delta,
                       **{"δ/h": delta / h[0], "max-norm error": error[:, 0]})
            x, order, low, high = _cuts(evidence, scheme, target)
            passing = (x >= finest) & (x <= coarsest)
            bars = np.nan_to_num(np.clip([order - low, high - order], 0, None))
            # Schemes beside each other, for the bars of schemes that agree would hide one another.
            at, x = x, x * 1.07 ** (schemes.index(scheme) - (len(schemes) - 1) / 2)
            for shown, line in ((~passing, dict(linestyle=dash)), (passing, dict(linestyle="none", alpha=0.3))):
                if shown.any():
                    curve = orders[target].errorbar(x, np.where(shown, order, np.nan), yerr=np.where(shown, bars, 0.0),
                                                    elinewidth=0.8, **styles[scheme], **line)
                    hover.mark(curve, labels[scheme], TARGETS[target], δ=at, order=order,
                               interval=[f"[{names.order(a)}, {names.order(b)}]" for a, b in zip(low, high)])
        limits = axes.padded(np.concatenate([delta for _, delta, _ in planes.values()]))
        bounds, (lines,) = axes.error_bounds([([(delta, error[:, 0], None) for _, delta, error in planes.values()],
                                               [1.0])], (width, tall))
        for panel in (*orders.values(), errors):
            axes.set_log_limits(panel, limits, bounds if panel is errors else (0.1, 1.0), (width, tall))
            panel.tick_params(which="both", top=True, right=True)
            panel.set_xlabel(r"$\delta$")
        for i, (target, panel) in enumerate(orders.items()):
            panel.set(yscale="linear", ylim=(-0.6, 2.6))
            panel.axvspan(finest, coarsest, color="#EDF0F3", linewidth=0, zorder=0)
            panel.annotate("h passes δ", (math.sqrt(finest * coarsest), 0), xycoords=panel.get_xaxis_transform(),
                           xytext=(0, 4), textcoords="offset points", ha="center", va="bottom", fontsize=9, color=GRAY)
            panel.axhline(1.0, color=GRAY, linewidth=0.8)
            panel.tick_params(labelleft=i == 0)
            panel.set_title(TARGETS[target], fontsize=10.5, pad=5)
        axes.draw_references(errors, lines, (width, tall), GRAY)
        orders["nonlocal"].set_ylabel("order in $h$ at this horizon")
        errors.set_ylabel("max-norm error at the finest $h$")
        keys = [Line2D([], [], **styles[scheme]) for scheme in schemes]
        keys += [Line2D([], [], color=GRAY, linestyle="solid"), Line2D([], [], color=GRAY, linestyle=DASHES[1])]
        key = foot_legend(figure, left, keys, [*(labels[scheme] for scheme in schemes), *TARGETS.values()], 2,
                          spacing=2.5, bottom=0.12)
        hover.mark_legend(key, [*(labels[scheme] for scheme in schemes), *(None for _ in TARGETS)])
        return figure


KIND = Kind(drawings)
