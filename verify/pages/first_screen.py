"""The first screen of a page: the finding in a sentence, counts as tiles, the most telling picture.

A tile is understood by its sign and its word; the colour only helps.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.answers import (
    LinkedLine,
    MistakesByLibrary,
    RefereeQuestion,
    answer_questions,
    explain,
    find_mistakes,
)
from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections import page as of_page
from verify.pages.sections.page_contents import COLOURS, ClaimView
from verify.pages.sections.scene.stability import MEANINGS
from verify.pages.sections.section import SectionPlace, Tile, VisibleSection, walk
from verify.pages.sections.section import sections as found_sections
from verify.pages.text.legend import SIGNS, counts_of
from verify.pages.text.typography import join_and, superscript, whole
from verify.scenes.results.claim import Category, Outcome, describe_counts
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import Report
from verify.scenes.results.stability import KINDS, Kind, StabilityResult
from verify.verdict import Verdict

# A judged run's sign, and the verdict whose colour it has.
_RUN_SIGNS: dict[Kind, tuple[str, Verdict]] = {
    "stable": ("✓", Verdict.PROVED),
    "drifts": ("↝", Verdict.MEASURED),
    "unstable: scheme": ("✗", Verdict.REFUTED),
    "unstable: arithmetic": ("✗", Verdict.REFUTED),
    "escapes": ("↗", Verdict.ENCLOSED),
    "overflow": ("∞", Verdict.REFUTED),
    "underflow": ("↓", Verdict.REFUTED),
    "sensitive": ("≀", Verdict.ENCLOSED),
    "undecided": ("?", Verdict.UNDECIDED),
}
# The sign of a statement's category, and what it means.
_CATEGORIES = {
    Category.AS_MEANT: ("✓", "every fair reading holds; a strict one may not"),
    Category.MISPRINTED: ("✓", "what is meant holds; the letter says something else"),
    Category.DEPENDS: (
        "≈", "one reading holds; a fair one is refuted, or not decided",
    ),
    Category.REFUTED: ("✗", "every reading is refuted, also the most favourable one"),
    Category.UNDECIDED: (
        "?", "no reading is shown to hold, and not all are refuted",
    ),
}  # fmt: skip
# Up to so many proofs have a sentence and a tile each; more of them are counted.
_FEW_PROOFS = 4


@dataclass(frozen=True)
class Refutation:
    """The most telling refutation; `same_row_claims` are other tables that print the same row."""

    claim: ClaimView
    same_row_claims: tuple[ClaimView, ...]


@dataclass(frozen=True)
class FirstScreen:
    """The content of the first screen.

    `causes`: what explains that statements do not hold. `wrong`: the mistakes by library, in place
    of a refutation. `plot` stands here and nowhere else on the page; `place` is the section that it
    belongs to.
    """

    finding: str
    tiles: tuple[Tile, ...]
    answers: tuple[RefereeQuestion, ...]
    refutation: Refutation | None
    plot: Plot | None
    place: SectionPlace | None
    wrong: MistakesByLibrary | None = None
    causes: tuple[LinkedLine, ...] = ()


def first_screen(
    report: Report, claims: Sequence[ClaimView], sections: Sequence[VisibleSection]
) -> FirstScreen:
    """Return the first screen; its picture is taken from a refuted table or from `sections`."""
    refutation = _select_refutation(claims)
    plot, place = (refutation.claim.plot if refutation else None), None
    if plot is None:
        plot, place = _select_picture(sections)
    sentence, tiles = _finding_of_sections(report)
    all_tiles = tuple(_build_tiles(report)) or tuple(tiles)
    wrong = find_mistakes(claims)
    telling = None if wrong else refutation
    causes = tuple(explain(report.causes, claims))
    # What the table is, the causes say above.
    main_finding = finding(report, None if causes else refutation) or sentence
    questions = answer_questions(report, claims)
    return FirstScreen(main_finding, all_tiles, questions, telling, plot, place, wrong, causes)


def _finding_of_sections(report: Report) -> tuple[str, Sequence[Tile]]:
    """Return the sentence and tiles of a section, for a report without claims and proofs."""
    findings = (section.speaks(report) for _, section in found_sections(of_page.FILES))
    return next(filter(None, findings), ("The report holds no claim and no proof.", ()))


# -- the finding in one sentence ------------------------------------------------------------------


def finding(report: Report, refutation: Refutation | None = None) -> str:
    """Return a summary of the claims, or of the proofs and judged runs; "" without any."""
    if report.statements:
        statement_counts = describe_counts(report.statements, report.claims)
        table_finding = _describe_refuted_table(refutation).removeprefix("; ")
        return f"{statement_counts}." + (
            f" {table_finding[:1].upper()}{table_finding[1:]}." if table_finding else ""
        )
    if report.claims:
        claims = _finding_of_claims([c.verdict for c in report.claims])
        return f"{claims}{_describe_refuted_table(refutation)}."
    proofs, judged_runs = _proofs(report), _stability_tiles(report)
    if kept := _kept_verdicts(report):
        counts = join_and(f"{n} {v.lower()}" for v, n in Counter(kept).items())
        return f"Of {len(kept)} statements on what steps keep: {counts}."
    sentences = [_finding_of_runs(judged_runs)] if judged_runs else []
    if proofs and (len(proofs) <= _FEW_PROOFS or not judged_runs):
        sentences = [_finding_of_proofs(proofs), *sentences]
    return " ".join(sentences)


def _proofs(report: Report) -> list[ProofResult]:
    return [proof for scene in report.scenes for proof in scene.proofs]


def _kept_verdicts(report: Report) -> list[Verdict]:
    """Return the verdicts on what steps are meant to keep, in the order of verdicts."""
    kept = [x.verdict for scene in report.scenes for result in scene.keeps for x in result.keeps]
    return sorted(kept, key=list(Verdict).index)


def _stability_tiles(report: Report) -> list[StabilityResult]:
    return [run for scene in report.scenes for run in scene.stability]


def _finding_of_claims(verdicts: Sequence[Verdict]) -> str:
    counts = Counter(verdicts)
    words = [(counts[v], v.lower()) for v in Verdict if counts[v]]
    if len(words) == 1:
        count, word = words[0]
        return f"The one claim is {word}" if count == 1 else f"All {count} claims are {word}"
    (count, word), *smaller = words
    first = f"{count} {'is' if count == 1 else 'are'} {word}"
    return f"Of {len(verdicts)} claims, {join_and([first, *(f'{n} {w}' for n, w in smaller)])}"


def _describe_refuted_table(refutation: Refutation | None) -> str:
    """Return how much of the refuted table is wrong, as the beginning of its evidence has it."""
    if refutation is None or not refutation.claim.is_table:
        return ""
    share = refutation.claim.result.evidence.partition(":")[0]
    return f"; in {refutation.claim.name}, {share}"


def _finding_of_proofs(proofs: Sequence[ProofResult]) -> str:
    if len(proofs) <= _FEW_PROOFS:
        return "; ".join(_finding_of_proof(p) for p in proofs) + "."
    summary = join_and(f"{n} {text}" for _, n, text in _proof_counts(proofs))
    return f"{len(proofs)} step maps were examined: {summary}."


def _proof_counts(proofs: Sequence[ProofResult]) -> list[tuple[Verdict, int, str]]:
    preserving = sum(p.keeps is True for p in proofs)
    several = any(p.form is not None for p in proofs)
    ordered = sum(p.order is not None for p in proofs)
    parts = [
        (Verdict.PROVED, preserving, "with S ≡ 0" if several else "with det J ≡ 1"),
        (Verdict.PROVED, ordered, f"with {'an S' if several else 'a ΔJ'} of a proved order in h"),
        (Verdict.UNDECIDED, len(proofs) - preserving - ordered, "undecided"),
    ]
    return [part for part in parts if part[1]]


def _finding_of_proof(proof: ProofResult) -> str:
    if proof.keeps:
        exactly = "preserves area exactly (det J ≡ 1)" if proof.form is None else "is symplectic"
        return f"{proof.scheme_title} {exactly}"
    if proof.order is not None:
        return f"{proof.what} of {proof.scheme_title} is of order {_power_of_h(proof.order)}"
    return f"the order of {proof.what} of {proof.scheme_title} is undecided"


def _finding_of_runs(judged_runs: Sequence[StabilityResult]) -> str:
    counts = Counter(run.kind for run in judged_runs)
    return f"Of {whole(len(judged_runs))} judged runs: {counts_of(counts)}."


def _power_of_h(power: int) -> str:
    return f"h{superscript(power)}"


# -- tiles ----------------------------------------------------------------------------------------


def _build_tiles(report: Report) -> list[Tile]:
    if report.statements:
        counts = Counter(statement.category for statement in report.statements)
        return [
            Tile(COLOURS[c], sign, whole(counts[c]), _word(c, counts[c]), meaning, counts[c])
            for c, (sign, meaning) in _CATEGORIES.items()
            if counts[c]
        ]
    if verdicts := Counter([c.verdict for c in report.claims] or _kept_verdicts(report)):
        return [
            Tile(v, sign, whole(verdicts[v]), v.lower(), meaning, verdicts[v])
            for v, (sign, meaning) in SIGNS.items()
            if verdicts[v]
        ]
    proofs, judged_runs = _proofs(report), _stability_tiles(report)
    # The tiles of many proofs would hide the judged runs.
    if judged_runs and len(proofs) > _FEW_PROOFS:
        return _tiles_of_runs(judged_runs)
    if len(proofs) > _FEW_PROOFS:
        return [
            Tile(v, SIGNS[v][0], whole(n), text, weight=n) for v, n, text in _proof_counts(proofs)
        ]
    return [_tile_of_proof(proof) for proof in proofs]


def _word(category: Category, count: int) -> str:
    """Return the tile's word: “refuted” and “undecided” have no verb there."""
    words = category.verb(count).removeprefix("is ").removeprefix("are ")
    return words.removesuffix(" in every reading")


def _tiles_of_runs(judged_runs: Sequence[StabilityResult]) -> list[Tile]:
    tiles = []
    for kind, count in Counter(run.kind for run in judged_runs).items():
        sign, verdict = _RUN_SIGNS[kind]
        tiles.append(Tile(verdict, sign, whole(count), kind, MEANINGS[kind], count))
    return sorted(tiles, key=lambda tile: KINDS.index(tile.word))


def _tile_of_proof(proof: ProofResult) -> Tile:
    verdict, sign = proof.verdict, SIGNS[proof.verdict][0]
    defect, structure = proof.what, "area" if proof.form is None else "the symplectic form"
    if proof.keeps:
        return Tile(
            verdict, sign, f"{defect} ≡ 0", proof.scheme_title, f"preserves {structure} exactly"
        )
    if proof.order is not None:
        meaning = f"proved: changes {structure} at this order in every step"
        return Tile(
            Verdict.REFUTED,
            "≠",
            f"{defect} ∼ {_power_of_h(proof.order)}",
            proof.scheme_title,
            meaning,
        )
    return Tile(verdict, sign, defect, proof.scheme_title, "its order is undecided")


# -- the most telling picture ---------------------------------------------------------------------


def _select_refutation(claims: Sequence[ClaimView]) -> Refutation | None:
    """Return a refuted table if there is one, since it compares numbers; else the first refutation.

    A refuted reading of a statement that holds in another reading is not taken.
    """
    refuted = [
        c
        for c in claims
        if c.result.verdict is Verdict.REFUTED
        and (c.statement.outcome is Outcome.REFUTED if c.statement else c.result.standing != "ours")
    ]
    if not refuted:
        return None
    tables = [c for c in refuted if c.is_table]
    claim = next(iter(tables), refuted[0])
    # One row may be printed by several tables; the refutation then concerns all of them.
    other_tables = (c for c in tables if c is not claim and not c.is_later_reading)
    tables_of_row = [c for c in other_tables if c.printed_row == claim.printed_row]
    return Refutation(claim, tuple(tables_of_row))


def _select_picture(sections: Sequence[VisibleSection]) -> tuple[Plot | None, SectionPlace | None]:
    """Return the picture of the least rank: the cost in area comes first, then stability."""
    pictures = (picture for section in walk(sections) for picture in section.pictures)
    _, plot, place = min(
        pictures, key=lambda ranked_picture: ranked_picture[0], default=((), None, None)
    )
    return plot, place
