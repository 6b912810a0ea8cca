"""`verify report --errata DIR`: what of a paper has to be corrected, ready to be sent.

`errata.tex` and `errata.md` have each statement as it is printed, as it should read, why, and what
that changes in the paper; its tables as they come out; and what explains the mistakes.
`editor.html` is one page for an editor. Each table has a stand-alone program beside it.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from verify.errors import InputError
from verify.files import write_atomically
from verify.pages.answers import explain
from verify.pages.errata.latex import escape, latex, latex_cell, latex_sentence
from verify.pages.markdown.inline_text import markdown
from verify.pages.page import TEMPLATES, PageView, environment, page_view
from verify.pages.sections.page.repairs import EFFECTS, RepairView, repair_views
from verify.pages.sections.page_contents import PRINTED_ROW_START, Anchors, ClaimView
from verify.pages.text.prose_markup import cell, prose, sentence
from verify.prose import Prose
from verify.prose import prose as prose_of
from verify.scenes.results.claim import ClaimResult, describe_counts
from verify.scenes.results.report import Report
from verify.verdict import Verdict

_FILES = ("errata.tex", "errata.md", "editor.html")


@dataclass(frozen=True)
class Erratum:
    """A statement with its repair; `reasons`: the evidence against the printed words.

    `repairs`: the words that hold, each with its verdict; `effect`: what changes in the paper.
    """

    source: str
    printed: Prose
    repairs: tuple[tuple[Prose, Verdict], ...]
    reasons: tuple[Prose, ...]
    effect: str


@dataclass(frozen=True)
class RepairedTable:
    """A printed table as it was computed; `script`: the name of the program beside it, or ""."""

    claim: ClaimView
    script: str

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The computed rows; where each start has a printed row, that is not among them."""
        return [row for row in self.claim.computed_rows if not row[0].startswith(PRINTED_ROW_START)]


def write_errata(report: Report, folder: Path) -> list[Path]:
    """Write the erratum into the folder, and return the paths of its files.

    Raises InputError for a report that counts no statements of a paper.
    """
    if not report.statements:
        raise InputError("--errata", report.title, "is no paper whose statements are counted")
    view = page_view(report)
    tables = _repaired_tables(_wrong_tables(view))
    context = {
        "report": report,
        "title": _title(report.title),
        "page": view,
        "counts": describe_counts(report.statements, report.claims),
        "effects": EFFECTS,
        "causes": [line.sentence for line in explain(report.causes, view.claims)],
        "errata": [_erratum(repair, view.claims) for repair in repair_views(view)],
        "tables": tables,
    }
    texts = {name: _environment(name).get_template(f"errata/{name}").render(context)
             for name in _FILES}  # fmt: skip
    texts |= {table.script: table.claim.result.reproduction for table in tables if table.script}
    for name, text in texts.items():
        write_atomically(folder / name, re.sub("\n{3,}", "\n\n", text).rstrip("\n") + "\n")
    return [folder / name for name in texts]


def _environment(name: str) -> Environment:
    """Return the templates' environment; in HTML text is escaped by itself, else by the filters."""
    if name.endswith(".html"):
        return environment()
    templates = Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"), undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, autoescape=False,  # noqa: S701 - no HTML
        comment_start_string="{##", comment_end_string="##}",
    )  # fmt: skip
    if name.endswith(".tex"):
        templates.filters |= {"prose": latex, "sentence": latex_sentence, "cell": latex_cell,
                              "text": escape}  # fmt: skip
    else:
        templates.filters |= {
            "prose": lambda text: markdown(prose(text)),
            "sentence": lambda text: markdown(sentence(text)),
            "cell": lambda text: markdown(cell(text)),
            "text": markdown,
        }
    return templates


def _title(title: str) -> str:
    """Return the paper's title where it stands in quotation marks, else the whole title."""
    quoted = re.match("“[^”]+”", title)
    return quoted[0] if quoted else title


def _erratum(repair: RepairView, claims: Sequence[ClaimView]) -> Erratum:
    statement = repair.statement.statement
    assert statement is not None  # noqa: S101 - a repair is of a statement
    by_id = {claim.result.id: claim.result for claim in claims}
    effects = [effect for _, _, effect in repair.repairs if effect]
    return Erratum(
        source=statement.source or statement.id,
        printed=statement.statement,
        repairs=tuple((words, claim.result.verdict) for claim, words, _ in repair.repairs),
        reasons=_reasons([by_id[name] for name in statement.readings]),
        effect=effects[0] if effects else EFFECTS[""],
    )


def _reasons(readings: Sequence[ClaimResult]) -> tuple[Prose, ...]:
    """Return what speaks against the letter, if that is a misprint, and against a fair reading.

    The readings stand in the order of the file. Of a misprint that is true to the letter its remark
    says what speaks against it.
    """
    reasons: dict[str, Prose] = {}
    for reading in readings:
        is_refuted = reading.verdict is Verdict.REFUTED
        if reading.standing in ("fair", "misprint") and (is_refuted or reading.standing != "fair"):
            reason = reading.evidence if is_refuted else reading.remark or reading.evidence
            if is_refuted and reading.reading:
                reason = prose_of("read “", reading.reading, "”: ", reason)
            reasons.setdefault(reading.standing, reason)
    return tuple(reasons.values()) or (readings[0].evidence,)


def _wrong_tables(view: PageView) -> list[ClaimView]:
    """Return the paper's tables that are refuted, each once."""
    tables = (claim for claim in view.claims if claim.is_table_of_paper)
    return [claim for claim in tables if claim.result.verdict is Verdict.REFUTED]


def _repaired_tables(claims: Sequence[ClaimView]) -> list[RepairedTable]:
    """Return the tables, each with the name of the file of the program that computes it, or ""."""
    tables: list[RepairedTable] = []
    anchors = Anchors()  # ids that differ in signs alone still have different names
    for claim in claims:
        slug = re.sub("[^a-z0-9]+", "-", claim.result.id.lower()).strip("-")
        name = anchors.take("program", slug).removeprefix("program-") + ".py"
        tables.append(RepairedTable(claim, name if claim.result.reproduction else ""))
    return tables
