"""From a study to the figure of a paper, and a solver of one's own, judged: cells for a notebook, or a script.

    python3 paper_figure.py [--latex]     # --latex: text is set by LaTeX, which has to be there

Results go to the folder out, the figure to convergence.pdf, one column wide.
"""

# %% Run a study; cases that are stored already are not run again

from pathlib import Path
import sys

import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter
import numpy as np

import acstudy

table = acstudy.run(Path(__file__).with_name("wave.toml"), out="out")

# %% A figure one column wide, with fonts embedded as journals ask for

plt.rcParams.update({
    "font.size": 8, "lines.linewidth": 1, "lines.markersize": 4, "axes.linewidth": 0.6, "pdf.fonttype": 42,
    "text.usetex": "--latex" in sys.argv, "font.family": "serif" if "--latex" in sys.argv else "sans-serif"})

figure, axes = plt.subplots(figsize=(3.4, 3.2), layout="constrained")
for marker, path in zip("osv", dict.fromkeys(table["path"])):
    rows = table[table["path"] == path]
    order, low, high, h, error = (np.array(rows[name]) for name in ("order", "low", "high", "h", "error_linf"))
    words = f"${path}$: order {round(order[0], 2) + 0:.2f} [{low[0]:.2f}, {high[0]:.2f}]"
    axes.loglog(h, error, marker=marker, label=words.replace("delta", r"\delta"))
axes.loglog(h, 0.2 * error[0] * h / h[0], "k:", label="order 1")
axes.xaxis.set_minor_formatter(NullFormatter())
axes.set(xlabel="spacing $h$", ylabel="error at $t = 1$, max norm")
axes.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1))
figure.savefig("convergence.pdf")

# %% A solver of one's own: upwind on the same problem, with its fields and source from acstudy

scene = acstudy.Scene(period="2*pi", T=1, c="1 + cos(x)/2", u="sin(x - t)")


def upwind_error(N):
    """Spacing and largest error at T of forward Euler and upwind differences of c u on N points."""
    h = scene.period / N
    x = h * np.arange(N)
    steps = int(np.ceil(2 * scene.T / h))
    dt = scene.T / steps
    u = scene.u(x, 0)
    for n in range(steps):
        flux = scene.c(x) * u
        u = u + dt * (scene.source(x, n * dt) - (flux - np.roll(flux, 1)) / h)
    return h, abs(u - scene.u(x, scene.T)).max()


h, errors = zip(*map(upwind_error, (40, 80, 160, 320, 640)))
print(acstudy.judge(h, errors, order=1))

# %% The same as a test: an AssertionError says why if the order is not there

acstudy.assert_order(h, errors, 1)
