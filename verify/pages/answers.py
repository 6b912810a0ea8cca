"""A referee's first questions, answered from the report's own data in a line or two each.

Are the statements on every H right; does the scheme preserve area; do the printed tables stand; and
which scheme has the smaller error at equal run time? A question for which the report has no data is
left out. Of an audit: which mistakes does each library have?
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from verify.pages.sections.page_contents import ClaimView
from verify.pages.text.typography import join_and
from verify.prose import Formula, Prose, join_prose, prose
from verify.scenes.paper_sections import Cause
from verify.scenes.results.claim import Category
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.report import Report, SceneResult
from verify.verdict import Verdict

_QUESTIONS = {"ΔJ": "Is area preserved?", "S": "Is the symplectic form preserved?"}
# A single answer repeats the tiles, unless it has the formula of a few ΔJ.
_MIN_ANSWERS = 2
# Up to so many schemes and systems are few.
_FEW_ITEMS = 3
_MAX_LINKS = 12
_WRONG = {Category.REFUTED, Category.UNDECIDED}
# Characters of a leading coefficient that is shown here; the proof shows any.
_MAX_LEADING_LENGTH = 100
# Severities that begin so are about the last digits of tables; they are counted, not named.
_DIGITS = "digits"
# At most so many methods are named for each kind of mistake; the others are counted.
_MAX_NAMED = 6


class LinkedLine(NamedTuple):
    """A line that ends with links: names of claims with their anchors."""

    sentence: Prose
    links: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class RefereeQuestion:
    """A question with the lines that answer it."""

    question: str
    lines: tuple[LinkedLine, ...]


def answer_questions(report: Report, claims: Sequence[ClaimView]) -> tuple[RefereeQuestion, ...]:
    """Return the questions with their answers; none if the page below says more.

    Of a paper, only what it asks itself: systems that no statement of it names stand below.
    """
    named = {c.scene_title for c in claims if c.statement and c.scene_title}
    scenes = [s for s in report.scenes if not report.statements or (s.title or s.name) in named]
    area = list(_answer_structure(scenes))
    entries = [
        *_answer_theory(claims, report.causes),
        *area,
        *_answer_tables(claims),
        *([] if report.statements else _answer_equal_cost(scenes)),
    ]
    few = len(report.scenes) <= _FEW_ITEMS and all(
        len(question.lines) <= _FEW_ITEMS for question in area
    )
    return tuple(entries) if len(entries) >= _MIN_ANSWERS or (area and few) else ()


def explain(causes: Sequence[Cause], claims: Sequence[ClaimView]) -> Iterator[LinkedLine]:
    """Yield each cause, whom it disfavours and how it may have come about.

    The links lead to the statements that it explains.
    """
    for cause in causes:
        first = [
            c
            for c in claims
            if c.statement and c.statement.id in cause.explains and not c.is_later_reading
        ]
        # Several readings share a name; the dictionary, built in reverse, keeps the first one's
        # anchor.
        names = {c.name: c.anchor for c in reversed(first)}
        links = tuple((c.name, names[c.name]) for c in first if names[c.name] == c.anchor)
        sentences = [cause.says, *filter(None, (cause.disfavours, cause.origin))]
        yield LinkedLine(join_prose(" ", sentences), links)


def _answer_theory(
    claims: Sequence[ClaimView], causes: Sequence[Cause]
) -> Iterator[RefereeQuestion]:
    """Yield the outcomes of the statements none of whose readings speaks of a single H.

    Those are named that are refuted, or that do not hold because of one of the causes.
    """
    specific = {c.statement.id for c in claims if c.statement and c.result.scene}
    general = [
        c
        for c in claims
        if c.statement and not c.is_later_reading and c.statement.id not in specific
    ]
    if not general:
        return
    counts = Counter(c.statement.category for c in general if c.statement)
    clauses = [f"{n} {category.verb(n)}" for category in Category if (n := counts[category])]
    sentence = f"Of {len(general)} statements on every H, {join_and(clauses)}"
    explained = {name for cause in causes for name in cause.explains}
    wrong = [
        c
        for c in general
        if c.statement and (c.statement.id in explained or c.statement.category in _WRONG)
    ]
    # Links follow a colon; a long list of them would hide the sentence.
    if not 0 < len(wrong) <= _MAX_LINKS:
        end = "." if counts[Category.REFUTED] else "; none is refuted in every reading."
        yield RefereeQuestion("Is the theory right?", (LinkedLine(Prose(sentence + end)),))
        return
    links = tuple((c.name, c.anchor) for c in wrong)
    line = Prose(f"{sentence}. What needs a repair:")
    yield RefereeQuestion("Is the theory right?", (LinkedLine(line, links),))


def _answer_structure(scenes: Sequence[SceneResult]) -> Iterator[RefereeQuestion]:
    """Yield a line for each scheme, with the leading term for each H that is not preserved."""
    for structure, question in _QUESTIONS.items():
        # By scheme, not by scene, so that each scheme has one line however many H it is proved for.
        by_scheme: dict[str, list[tuple[str, ProofResult]]] = {}
        for scene in scenes:
            for proof in scene.proofs:
                if proof.what == structure:
                    titled_proof = scene.title or scene.name, proof
                    by_scheme.setdefault(proof.scheme, []).append(titled_proof)
        lines = tuple(
            LinkedLine(_line_of_scheme(scheme, proofs)) for scheme, proofs in by_scheme.items()
        )
        if lines:
            yield RefereeQuestion(question, lines)


def _line_of_scheme(scheme: str, proofs: Sequence[tuple[str, ProofResult]]) -> Prose:
    identity = "det J ≡ 1" if proofs[0][1].form is None else "S ≡ 0"
    if all(proof.keeps for _, proof in proofs):
        return Prose(f"{scheme}: yes, {identity} is proved")
    parts: list[Prose] = []
    for title, proof in proofs:
        title_note = f" ({title})" if len(proofs) > 1 else ""
        if proof.keeps:
            parts.append(prose(f"{identity}{title_note}"))
        elif proof.order is None:
            parts.append(prose(f"not decided{title_note}"))
        else:
            parts.append(prose(*_describe_defect(proof, proof.order), title_note))
    negation = "no; " if any(proof.order is not None for _, proof in proofs) else ""
    sentence_parts: list[str | Prose] = [f"{scheme}: {negation}"]
    for k, part in enumerate(parts):
        sentence_parts += ["; " if k else "", part]
    return prose(*sentence_parts)


def _describe_defect(proof: ProofResult, power: int) -> list[str | Prose]:
    """Return ΔJ with its leading term if that is short, else its order alone."""
    leading = proof.readable.leading or proof.leading
    if proof.form is None and leading and len(leading) <= _MAX_LEADING_LENGTH:
        remainder = Formula(f"h**{power + 1}")
        return ["ΔJ = ", Formula(f"({leading})*h**{power}"), " + O(", remainder, ")"]
    structure = "ΔJ" if proof.form is None else "S"
    return [f"{structure} = O(", Formula(f"h**{power}"), "), no smaller"]


def _answer_tables(claims: Sequence[ClaimView]) -> Iterator[RefereeQuestion]:
    """Yield how much of each printed table is refuted, as the beginning of its evidence has it."""
    by_share: dict[str, list[ClaimView]] = {}
    for claim in claims:
        if claim.is_table_of_paper:
            # The evidence of a table begins with the share that is refuted, up to a colon.
            share = str(claim.result.evidence).partition(":")[0]
            refuted = claim.result.verdict is Verdict.REFUTED
            by_share.setdefault(share if refuted else claim.result.verdict.lower(), []).append(
                claim
            )
    if by_share:
        lines = (
            LinkedLine(
                Prose(f"{share[:1].upper()}{share[1:]}:"), tuple((c.name, c.anchor) for c in tables)
            )
            for share, tables in by_share.items()
        )
        yield RefereeQuestion("Do the printed tables stand?", tuple(lines))


def _answer_equal_cost(scenes: Sequence[SceneResult]) -> Iterator[RefereeQuestion]:
    """Yield the comparisons at equal run time with schemes that do not preserve area."""
    lines = []
    for scene in scenes:
        not_preserving = {proof.scheme for proof in scene.proofs if not proof.area_preserving}
        for comparison in scene.work_precision.comparisons if scene.work_precision else ():
            if comparison.error is not None and {comparison.one, comparison.other} & not_preserving:
                name = scene.title or scene.name
                lines.append(LinkedLine(prose(f"{name}: ", _first_sentence(comparison.sentence))))
    if lines:
        yield RefereeQuestion("Which scheme at equal cost?", tuple(lines))


def _first_sentence(text: Prose) -> Prose:
    parts: list[str] = []
    for part in text.parts:
        # Formulas and numbers are subclasses of str; only plain text can end a sentence.
        if type(part) is str and ". " in part:
            return Prose(*parts, part.partition(". ")[0] + ".")
        parts.append(part)
    return text


# -- the mistakes of libraries --------------------------------------------------------------------


@dataclass(frozen=True)
class MistakeKind:
    """One kind of mistake in one library: some of the claims, and how many more there are."""

    severity: str
    claims: tuple[ClaimView, ...]
    more_count: int


@dataclass(frozen=True)
class MistakesOfLibrary:
    """The mistakes of one library; `name` is the title of its section."""

    name: str
    mistakes: tuple[MistakeKind, ...]


@dataclass(frozen=True)
class MistakesByLibrary:
    """The mistakes of all libraries.

    `digits`: by library, the number of tables whose last digits alone are wrong; `faultless`: the
    libraries without a refuted claim.
    """

    libraries: tuple[MistakesOfLibrary, ...]
    digits: tuple[tuple[str, int], ...]
    faultless: tuple[str, ...]


def find_mistakes(claims: Sequence[ClaimView]) -> MistakesByLibrary | None:
    """Return the mistakes by library, or None if no refuted claim has a severity.

    Grave ones come first; tables that are wrong in their last digits only are counted.
    """
    refuted = [c for c in claims if c.result.verdict is Verdict.REFUTED and c.result.severity]
    if not refuted:
        return None
    grave = [c for c in refuted if not c.result.severity.startswith(_DIGITS)]
    sections = dict.fromkeys(c.result.section for c in grave)
    # The order of the sections is that of the claims, since dictionaries keep their order.
    slight = Counter(_name(c.result.section) for c in refuted if c not in grave)
    touched = {c.result.section for c in refuted}
    all_sections = dict.fromkeys(c.result.section for c in claims)
    return MistakesByLibrary(
        tuple(
            MistakesOfLibrary(
                _name(section), _mistakes([c for c in grave if c.result.section == section])
            )
            for section in sections
        ),
        tuple(slight.items()),
        tuple(_name(section) for section in all_sections if section not in touched),
    )


def _name(section: str) -> str:
    return section.removesuffix(", printed tables")


def _mistakes(claims: Sequence[ClaimView]) -> tuple[MistakeKind, ...]:
    mistakes = []
    for severity in dict.fromkeys(c.result.severity for c in claims):
        # Of several claims with one source and severity the first is named.
        first = {c.result.source: c for c in reversed(claims) if c.result.severity == severity}
        sources = [c for c in claims if c is first.get(c.result.source)]
        mistakes.append(
            MistakeKind(severity, tuple(sources[:_MAX_NAMED]), max(len(sources) - _MAX_NAMED, 0))
        )
    return tuple(mistakes)
