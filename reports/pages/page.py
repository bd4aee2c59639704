"""The page of a report: does everything hold, and then question by question what was claimed and what was observed."""

from dataclasses import dataclass

from markupsafe import Markup

from drawing import inlined, svg
from kinds import registry
from pages import claims, comparison, explorer, headline, in_parts, making, mutants, paths, questions, run_time
from pages.study import article, listing
from pages.verdicts import departing, verdicts
from reading import processes
from reading.made import made
from writing import figures, markup, tables

TITLE = "Asymptotic compatibility: convergence studies"
ORIGIN = ("study", "~title", "kind", "#findings", "computed", "version")


@dataclass(frozen=True)
class Section:
    """A question with everything that answers it."""
    question: questions.Question
    said: str           # what came out, in a sentence
    content: Markup


@dataclass(frozen=True)
class Words:
    """What a page says whatever its figures look like."""
    studies: list
    benches: list
    found: dict         # {question: its studies}
    curves: list        # whose errors and times are compared
    statements: tuple   # of the paper, further ones
    seeded: tuple       # mutants.read()
    verdicts: list
    departing: list     # entries of the ledger
    paths: Markup
    cases: Markup
    origin: Markup


def words(studies, benches=(), seeded=None):
    found, curves = questions.by_question(studies), run_time.curves(studies, benches)
    statements = claims.statements(studies)
    return Words(studies, benches, found, curves, statements, seeded, verdicts(found, curves, seeded, statements[0]),
                 departing(studies), paths.table(studies), _cases(studies), _origin(studies))


def files(words, drawn, compared=None, parts=False, kept=None):
    """{name: text of the page}. parts: a page for each question, else all in one.

    `words`: of words(); `drawn`: making.Drawn; `compared`: comparison.read(); `kept`: a reading.kept.Kept, or None.
    """
    found = _contents(words, drawn, compared, kept)
    return in_parts.files(found) if parts else {"index.html": str(markup.render("page.html", **found, parts=False))}


def html(studies, drawings, benches=(), seeded=None, compared=None):
    """The page in one as text. `drawings`: {name of a study: its drawings}."""
    return files(words(studies, benches, seeded), making.Drawn(drawings, [], []), compared)["index.html"]


def _contents(words, drawn, compared, kept):
    """What the templates of the page name."""
    studies, found, seeded = words.studies, words.found, words.seeded
    top = headline.study_of(found)
    # The headline figure stands on the first screen, and only there.
    first = next(iter(drawn.studies.get(top.name, [])), None) if top else None
    rest = {name: [one for one in of_study if one is not first] for name, of_study in drawn.studies.items()}
    inline = "".join(one.inline for group in (*drawn.studies.values(), drawn.costs, drawn.benches) for one in group)
    articles, faces = _made(studies, rest, svg.letters(inline), kept)
    sections = {question: _answers(question, found, articles, drawn.studies, words.statements)
                for question in questions.ALL}
    sections[questions.COMPATIBILITY] = words.paths + sections[questions.COMPATIBILITY]
    if words.curves or compared:
        sections[questions.RUN_TIME] = run_time.section(words.curves, drawn.costs, words.benches, drawn.benches,
                                                        compared)
    if seeded is not None:
        heading = Markup('<h3 id="q.seeded-mistakes">Mistakes seeded in the sources</h3>\n')
        sections[questions.MISTAKES] += heading + mutants.section(seeded)
    said = {one.question: one.said for one in words.verdicts}
    bad = words.departing
    nouns = _count(studies)
    return dict(
        title=TITLE, style=markup.style(inlined.dark(inline)), faces=Markup(faces),
        script=markup.script(), verdicts=words.verdicts, outcome=markup.outcome(
            {noun: sum(not one.as_expected for one in group) for noun, group in nouns.items()},
            {noun: len(group) for noun, group in nouns.items()}),
        departing=tables.entry_table(bad, "Not as expected") if bad else "", top=top,
        headline=figures.figure(first) if first else "",
        reading=headline.reading(top, bool(first and first.says)) if top else "",
        in_numbers=headline.in_numbers(top) if top else "",
        short_words=headline.SHORT_WORDS,
        noticed=[headline.noticed(study) for study in found[questions.MISTAKES]],
        sections=[Section(question, said.get(question, ""), content) for question, content in sections.items()
                  if content],
        asked=[question for question, content in sections.items() if content],
        cases=words.cases, origin=words.origin, seeded_absent=mutants.section(None) if seeded is None else "",
        compared_absent=comparison.section(None) if compared is None and not sections[questions.RUN_TIME] else "")


def _made(studies, drawings, letters, kept):
    """({name of a study: its part}, the fonts of all figures). `drawings`: of each study, those not shown elsewhere."""
    tasks = [(svg.faces, letters), *((_article, study, drawings.get(study.name, [])) for study in studies)]
    made_of = [("faces", letters)]
    if kept:
        made_of += (("article", kept.of_file(study.file), str(study.file), shown) for _, study, shown in tasks[1:])
    faces, *articles = made(tasks, made_of, kept, processes.results)
    return {study.name: Markup(text) for study, text in zip(studies, articles)}, faces


def _article(study, drawings):
    return str(article(study, drawings))    # plain text can be kept


def _answers(question, found, articles, drawings, statements):
    """Statement by statement, and then the studies of a question."""
    return markup.joined((*_statements(question, found, drawings, statements),
                          *(articles[study.name] for study in found[question])))


def _statements(question, found, drawings, statements):
    """The statements of the paper that belong to a question, and folded those of its studies that are of no paper."""
    of_paper, further = statements
    here = [one for one in of_paper if questions.of_statement(one) is question]
    if here:
        yield claims.table(here, drawings, question.title)
    there = [one for one in further if one.entries[0].study in found[question]]
    if there:
        said = Markup("Statement by statement {}").format(markup.note(markup.several(len(there), "statement")))
        yield tables.fold(said, claims.table(there, drawings, f"{question.title}: statements"))


def _count(studies):
    nouns = {}
    for study in studies:
        nouns.setdefault(registry.of(study).noun, []).extend(study.findings)
    return dict(sorted(nouns.items(), reverse=True))


def _cases(studies):
    data = explorer.data(studies)
    return markup.data(data) if data else ""


def _origin(studies):
    """Where the numbers are from: what all studies have in common, and a row for each."""
    if not studies:
        return ""
    common = {key: text for key, text in studies[0].provenance.items()
              if all(study.provenance.get(key) == text for study in studies)}
    rows = [(markup.link(study.name, study.name), study.title, study.kind, f"{len(study.findings)}",
             study.provenance.get("created", "–"), study.provenance.get("version", "–")) for study in studies]
    return markup.joined((tables.table("Where the numbers are from", ORIGIN, rows),
                          tables.fold("What they have in common", listing(common)) if common else ""))
