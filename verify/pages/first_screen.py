"""The first screen: the finding in a sentence, counts as tiles, and the most telling picture.

A tile says what it says by its sign and its word; the colour only helps.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.answers import Answer, answers
from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections import page as of_page
from verify.pages.sections.claim_view import COLOURS, ClaimView
from verify.pages.sections.scene.stability import MEANINGS
from verify.pages.sections.section import Place, Shown, Tile, walk
from verify.pages.sections.section import sections as found_sections
from verify.pages.text.signs import SIGNS
from verify.pages.text.typography import listed, superscript, whole
from verify.pages.text.words import counts_of
from verify.pages.wrong import Wrong, wrong_of
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import Report
from verify.scenes.results.stability import KINDS, Kind, StabilityResult
from verify.scenes.results.statement import Outcome, counted
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
# A statement's outcome: its sign, its word, what it means.
_OUTCOMES = {
    Outcome.HOLDS: (
        "✓", "hold as meant", "every fair reading holds; a strict or misprinted one may not",
    ),
    Outcome.IN_SOME: (
        "≈", "hold in some readings", "one reading holds; a fair one is refuted, or not decided",
    ),
    Outcome.REFUTED: ("✗", "refuted", "every reading is refuted, also the most favourable one"),
    Outcome.UNDECIDED: (
        "?", "undecided", "no reading is shown to hold, and not all are refuted",
    ),
}  # fmt: skip
_FEW = 4  # proofs that are told one by one


@dataclass(frozen=True)
class Refutation:
    """The most telling one; `same_row`: other refuted tables that print the very same row."""

    claim: ClaimView
    same_row: tuple[ClaimView, ...]


@dataclass(frozen=True)
class FirstScreen:
    """`wrong`: by library, in place of a refutation. `plot` stands here and nowhere else on the
    page; `place`: what it is of."""

    finding: str
    tiles: tuple[Tile, ...]
    answers: tuple[Answer, ...]
    refutation: Refutation | None
    plot: Plot | None
    place: Place | None
    wrong: Wrong | None = None


def first_screen(
    report: Report, claims: Sequence[ClaimView], sections: Sequence[Shown]
) -> FirstScreen:
    """What the page opens with; `sections`: those from which its picture may be."""
    refutation = _refutation(claims)
    plot, place = (refutation.claim.plot if refutation else None), None
    if plot is None:
        plot, place = _picture(sections)
    said, tiles = _of_a_section(report)
    own = tuple(_tiles(report)) or tuple(tiles)
    told = finding(report, refutation) or said
    wrong = wrong_of(claims)
    telling = None if wrong else refutation
    return FirstScreen(told, own, answers(report, claims), telling, plot, place, wrong)


def _of_a_section(report: Report) -> tuple[str, Sequence[Tile]]:
    """What is told where there is neither claim nor proof."""
    said = (section.speaks(report) for _, section in found_sections(of_page.FILES))
    return next(filter(None, said), ("The report holds no claim and no proof.", ()))


# -- the finding in one sentence ------------------------------------------------------------------


def finding(report: Report, refutation: Refutation | None = None) -> str:
    """What the claims say, or else the proofs and the judged runs; "" where there are none."""
    if report.statements:
        said = counted(report.statements, report.claims)
        of_numbers = _worst(refutation).removeprefix("; ")
        return f"{said}." + (f" {of_numbers[:1].upper()}{of_numbers[1:]}." if of_numbers else "")
    if report.claims:
        return f"{_finding_of_claims([c.verdict for c in report.claims])}{_worst(refutation)}."
    proofs, judged = _proofs(report), _stability_tiles(report)
    sentences = [_finding_of_runs(judged)] if judged else []
    if proofs and (len(proofs) <= _FEW or not judged):
        sentences = [_finding_of_proofs(proofs), *sentences]
    return " ".join(sentences)


def _proofs(report: Report) -> list[ProofResult]:
    return [proof for scene in report.scenes for proof in scene.proofs]


def _stability_tiles(report: Report) -> list[StabilityResult]:
    return [run for scene in report.scenes for run in scene.stability]


def _finding_of_claims(verdicts: Sequence[Verdict]) -> str:
    counted = Counter(verdicts)
    words = [(counted[v], v.lower()) for v in Verdict if counted[v]]
    if len(words) == 1:
        count, word = words[0]
        return f"The one claim is {word}" if count == 1 else f"All {count} claims are {word}"
    (count, word), *rest = words
    first = f"{count} {'is' if count == 1 else 'are'} {word}"
    return f"Of {len(verdicts)} claims, {listed([first, *(f'{n} {w}' for n, w in rest)])}"


def _worst(refutation: Refutation | None) -> str:
    """How much of the refuted table is wrong, as its evidence begins."""
    if refutation is None or not refutation.claim.is_table:
        return ""
    share = refutation.claim.result.evidence.partition(":")[0]
    return f"; in {refutation.claim.name}, {share}"


def _finding_of_proofs(proofs: Sequence[ProofResult]) -> str:
    if len(proofs) <= _FEW:
        return "; ".join(_finding_of_proof(p) for p in proofs) + "."
    shown = listed(f"{n} {text}" for _, n, text in _proof_counts(proofs))
    return f"{len(proofs)} step maps were examined: {shown}."


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
        return f"{proof.scheme} {exactly}"
    if proof.order is not None:
        return f"{proof.what} of {proof.scheme} is of order {_h(proof.order)}"
    return f"the order of {proof.what} of {proof.scheme} is undecided"


def _finding_of_runs(judged: Sequence[StabilityResult]) -> str:
    counted = Counter(run.kind for run in judged)
    return f"Of {whole(len(judged))} judged runs: {counts_of(counted)}."


def _h(power: int) -> str:
    return f"h{superscript(power)}"


# -- tiles ----------------------------------------------------------------------------------------


def _tiles(report: Report) -> list[Tile]:
    if report.statements:
        found = Counter(statement.outcome for statement in report.statements)
        return [
            Tile(COLOURS[o], sign, whole(found[o]), word, meaning, found[o])
            for o, (sign, word, meaning) in _OUTCOMES.items()
            if found[o]
        ]
    if report.claims:
        verdicts = Counter(c.verdict for c in report.claims)
        return [
            Tile(v, sign, whole(verdicts[v]), v.lower(), meaning, verdicts[v])
            for v, (sign, meaning) in SIGNS.items()
            if verdicts[v]
        ]
    proofs, judged = _proofs(report), _stability_tiles(report)
    if judged and len(proofs) > _FEW:
        return _tiles_of_runs(judged)
    if len(proofs) > _FEW:
        return [
            Tile(v, SIGNS[v][0], whole(n), text, weight=n) for v, n, text in _proof_counts(proofs)
        ]
    return [_tile_of_proof(proof) for proof in proofs]


def _tiles_of_runs(judged: Sequence[StabilityResult]) -> list[Tile]:
    tiles = []
    for kind, count in Counter(run.kind for run in judged).items():
        sign, verdict = _RUN_SIGNS[kind]
        tiles.append(Tile(verdict, sign, whole(count), kind, MEANINGS[kind], count))
    return sorted(tiles, key=lambda tile: KINDS.index(tile.word))


def _tile_of_proof(proof: ProofResult) -> Tile:
    verdict, sign = proof.verdict, SIGNS[proof.verdict][0]
    what, kept = proof.what, "area" if proof.form is None else "the symplectic form"
    if proof.keeps:
        return Tile(verdict, sign, f"{what} ≡ 0", proof.scheme, f"preserves {kept} exactly")
    if proof.order is not None:
        meaning = f"proved: changes {kept} at this order in every step"
        return Tile(Verdict.REFUTED, "≠", f"{what} ∼ {_h(proof.order)}", proof.scheme, meaning)
    return Tile(verdict, sign, what, proof.scheme, "its order is undecided")


# -- the most telling picture ---------------------------------------------------------------------


def _refutation(claims: Sequence[ClaimView]) -> Refutation | None:
    """A refuted table if there is one, since it sets numbers against numbers; else the first.

    Of a statement that holds in some reading none is told.
    """
    refuted = [
        c
        for c in claims
        if c.result.verdict is Verdict.REFUTED
        and (c.of.outcome is Outcome.REFUTED if c.of else c.result.standing != "ours")
    ]
    if not refuted:
        return None
    tables = [c for c in refuted if c.is_table]
    claim = next(iter(tables), refuted[0])
    others = (c for c in tables if c is not claim and not c.again)
    same = [c for c in others if c.printed == claim.printed]
    return Refutation(claim, tuple(same))


def _picture(sections: Sequence[Shown]) -> tuple[Plot | None, Place | None]:
    """The most telling first: what a step size costs in area, then where schemes are stable."""
    found = (picture for each in walk(sections) for picture in each.pictures)
    _, plot, place = min(found, key=lambda each: each[0], default=((), None, None))
    return plot, place
