"""The page of benches: error against run time and work, how long an error takes, what it costs and where time goes."""

from html import escape

from kinds.bench import tables as bench_tables
from writing import markup

TITLE = "Error against run time"
FILE = "bench.html"
ABOUT = """How long does it take to be how accurate? Each case was run alone and repeatedly, after a run that does not
count, in turn with all others, so that a disturbance of the machine meets all alike. A time is the median of its runs;
all runs are in <code>bench.h5</code> and <code>bench.json</code>. Seconds are those of one machine; the work beside them
is not."""


def html(benches, drawings, links):
    """The page as text. `drawings`: rendered, of bench_figures; `links`: (address, name) of its navigation."""
    body = [_section("figures", "Figures", "".join(map(markup.figure, drawings)))]
    for i, (title, header, rows, note) in enumerate(bench_tables.page_tables(benches)):
        text = "".join(_row(cells) for cells in rows)
        body.append(_section(f"table-{i}", title, markup.table(map(escape, header), text, title) +
                             (f'<p class="note">{escape(note.replace("`", ""))}</p>\n' if note else "")))
    for i, bench in enumerate(benches):
        body.append(_section(f"origin-{i}", f"Provenance of {bench.file.parent.name}", _origin(bench)))
    return markup.document(TITLE, ABOUT, links, "".join(body))


def _row(cells):
    head, *others = map(escape, cells)
    return f'<tr><th scope="row">{head}</th>' + "".join(f"<td>{cell}</td>" for cell in others) + "</tr>\n"


def _section(anchor, title, content):
    return (f'<section aria-labelledby="{anchor}">\n<h2 id="{anchor}">{escape(title)}</h2>\n{content}</section>\n')


def _origin(bench):
    said = {"samples of a case": f"at least {bench.runs}, of at least {bench.least_seconds:g} s in all",
            "finished": "yes" if bench.complete else "no: some cases have fewer samples"}
    return markup.listing({**said, **bench.provenance})
