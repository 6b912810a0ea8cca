"""What a referee asks first, answered from the report's own data: a line or two each.

Is what is said of every H right; does the scheme preserve area; do the printed tables stand; and
which scheme has the smaller error at equal run time. A question that the report has no data for is
not asked.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from verify.pages.sections.claim_view import ClaimView
from verify.pages.text.typography import listed
from verify.prose import Formula, Prose, prose
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import Report
from verify.scenes.results.statement import Outcome
from verify.verdict import Verdict

_QUESTIONS = {"ΔJ": "Is area preserved?", "S": "Is the symplectic form preserved?"}
_LEAST = 2  # answers; of one alone the tiles say as much, but for the formula of a few ΔJ
_FEW = 3  # schemes, and systems
_MOST_LINKS = 12
_LONGEST = 100  # characters of a leading coefficient that is shown here; the proof shows any
# Of one statement, and of several; those that are refuted stand last, before their links.
_OUTCOMES = {
    Outcome.HOLDS: ("holds as meant", "hold as meant"),
    Outcome.IN_SOME: ("holds in some readings", "hold in some readings"),
    Outcome.UNDECIDED: ("is undecided", "are undecided"),
    Outcome.REFUTED: ("is refuted in every reading", "are refuted in every reading"),
}


class Line(NamedTuple):
    """A line that ends with links: names of claims with their anchors."""

    said: Prose
    links: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Answer:
    """A question with the lines that answer it."""

    question: str
    lines: tuple[Line, ...]


def answers(report: Report, claims: Sequence[ClaimView]) -> tuple[Answer, ...]:
    """The questions that are answered; of many proofs alone the page below says more."""
    area = list(_area(report))
    found = [*_causes(report, claims), *_theory(claims), *area, *_tables(claims), *_use(report)]
    few = len(report.scenes) <= _FEW and all(len(each.lines) <= _FEW for each in area)
    return tuple(found) if len(found) >= _LEAST or (area and few) else ()


def _causes(report: Report, claims: Sequence[ClaimView]) -> Iterator[Answer]:
    """What explains several statements, each with links to them."""
    lines = []
    for cause in report.causes:
        first = [c for c in claims if c.of and c.of.id in cause.explains and not c.again]
        names = {c.name: c.anchor for c in reversed(first)}  # of one name the first
        links = tuple((c.name, names[c.name]) for c in first if names[c.name] == c.anchor)
        lines.append(Line(cause.says, links))
    if lines:
        yield Answer("What is wrong, and why?", tuple(lines))


def _theory(claims: Sequence[ClaimView]) -> Iterator[Answer]:
    """Of the statements none of whose readings speaks of one H."""
    of_one = {c.of.id for c in claims if c.of and c.result.scene}
    general = [c for c in claims if c.of and not c.again and c.of.id not in of_one]
    if not general:
        return
    counts = Counter(c.of.outcome for c in general if c.of)
    told = [f"{n} {words[n != 1]}" for o, words in _OUTCOMES.items() if (n := counts[o])]
    refuted = [c for c in general if c.of and c.of.outcome is Outcome.REFUTED]
    told += [] if refuted else ["none is refuted in every reading"]
    end = ":" if 0 < len(refuted) <= _MOST_LINKS else "."
    links = tuple((c.name, c.anchor) for c in refuted) if end == ":" else ()
    line = f"Of {len(general)} statements on every H, {listed(told)}{end}"
    yield Answer("Is the theory right?", (Line(Prose(line), links),))


def _area(report: Report) -> Iterator[Answer]:
    """One line a scheme; of what does not preserve area the leading term, for each H."""
    for what, question in _QUESTIONS.items():
        by_scheme: dict[str, list[tuple[str, ProofResult]]] = {}
        for scene in report.scenes:
            for proof in scene.proofs:
                if proof.what == what:
                    named = scene.title or scene.name, proof
                    by_scheme.setdefault(proof.scheme, []).append(named)
        lines = tuple(Line(_line_of(scheme, found)) for scheme, found in by_scheme.items())
        if lines:
            yield Answer(question, lines)


def _line_of(scheme: str, found: Sequence[tuple[str, ProofResult]]) -> Prose:
    kept = "det J ≡ 1" if found[0][1].form is None else "S ≡ 0"
    if all(proof.keeps for _, proof in found):
        return Prose(f"{scheme}: yes, {kept} is proved")
    parts: list[Prose] = []
    for title, proof in found:
        of = f" ({title})" if len(found) > 1 else ""
        if proof.keeps:
            parts.append(prose(f"{kept}{of}"))
        elif proof.order is None:
            parts.append(prose(f"not decided{of}"))
        else:
            parts.append(prose(*_size(proof, proof.order), of))
    no = "no; " if any(proof.order is not None for _, proof in found) else ""
    shown: list[str | Prose] = [f"{scheme}: {no}"]
    for k, part in enumerate(parts):
        shown += ["; " if k else "", part]
    return prose(*shown)


def _size(proof: ProofResult, power: int) -> list[str | Prose]:
    """ΔJ with its leading term, where that is short; or that it is of this order."""
    leading = proof.shown.leading or proof.leading
    if proof.form is None and leading and len(leading) <= _LONGEST:
        rest = Formula(f"h**{power + 1}")
        return ["ΔJ = ", Formula(f"({leading})*h**{power}"), " + O(", rest, ")"]
    what = "ΔJ" if proof.form is None else "S"
    return [f"{what} = O(", Formula(f"h**{power}"), "), no smaller"]


def _tables(claims: Sequence[ClaimView]) -> Iterator[Answer]:
    """How much of each printed table is refuted, as its evidence begins."""
    by_share: dict[str, list[ClaimView]] = {}
    for claim in claims:
        if claim.is_table and claim.result.standing != "ours" and not claim.again:
            share = str(claim.result.evidence).partition(":")[0]
            refuted = claim.result.verdict is Verdict.REFUTED
            by_share.setdefault(share if refuted else claim.result.verdict.lower(), []).append(
                claim
            )
    if by_share:
        lines = (
            Line(
                Prose(f"{share[:1].upper()}{share[1:]}:"), tuple((c.name, c.anchor) for c in tables)
            )
            for share, tables in by_share.items()
        )
        yield Answer("Do the printed tables stand?", tuple(lines))


def _use(report: Report) -> Iterator[Answer]:
    """What is measured at equal run time of what was proved not to preserve area, and of others."""
    lines = []
    for scene in report.scenes:
        judged = {proof.scheme for proof in scene.proofs if not proof.area_preserving}
        for each in scene.work_precision.comparisons if scene.work_precision else ():
            if each.error is not None and {each.one, each.other} & judged:
                name = scene.title or scene.name
                lines.append(Line(prose(f"{name}: ", _first_sentence(each.sentence))))
    if lines:
        yield Answer("Which scheme at equal cost?", tuple(lines))


def _first_sentence(text: Prose) -> Prose:
    parts: list[str] = []
    for part in text.parts:
        if type(part) is str and ". " in part:
            return Prose(*parts, part.partition(". ")[0] + ".")
        parts.append(part)
    return text
