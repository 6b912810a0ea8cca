"""Results on claims, criteria and statements of a paper: verdicts with their evidence, outcomes.

A statement is what the paper prints; a reading is one precise meaning of it, and a claim with a
verdict. A sentence that asserts several things makes several statements.

**When a statement is refuted.** It is read in its most favourable sense first. It `holds` where
every `fair` reading holds, which is how it is meant, whatever a strict or misprinted one says;
holds `in some readings` where one does and a fair one is not shown to; and is `refuted` where every
reading is refuted; else it is `undecided`. So one reading in which it is true is enough for it not
to be refuted; a statement has at least one `fair` reading, or it is no statement of the paper.

**Thus, therefore, hence.** A sentence “A, thus B” asserts B: B has a verdict by itself, however it
is derived. That B follows from A is a second reading of the same statement, “the inference”, with
a verdict of its own. A true conclusion from a wrong inference therefore holds in some readings.

**Whose it is.** `fair`: what the sentence says to a willing reader. `strict`: it can be taken so,
and says more than the sentence needs. `misprint`: the letter, where the text around it shows that
another is meant. `ours`: a theorem or a question of those who check, which the paper does not
state; it is counted apart and is no reading of a statement.
"""

from collections import Counter
from collections.abc import Sequence
from enum import StrEnum
from typing import Literal

from verify.prose import Prose
from verify.scenes.frozen import ProseText, WithProse
from verify.verdict import Verdict

Standing = Literal["fair", "strict", "misprint", "ours"]  # see above
# What the repair of a statement changes elsewhere in the paper; "" is not said.
Effect = Literal["", "none", "table", "conclusion"]


class StepResult(WithProse):
    """A step of an argument, in words and formulas.

    `checked_by`: the machine checks of it, one text each; empty if there was none. `tried`:
    computed examples, which prove nothing by themselves.
    """

    text: ProseText
    checked_by: tuple[ProseText, ...] = ()
    tried: tuple[ProseText, ...] = ()


class CriterionResult(WithProse):
    """One of the paper's four criteria for one scheme in one scene."""

    number: int
    scheme: str
    verdict: Verdict
    evidence: ProseText


class ClaimResult(WithProse):
    """One claim with its verdict; `evidence` is one line, `details` a table of texts.

    `scene` is empty if the claim is about every H. `section` is its place in the paper, such as
    "4.1 The Duffing system"; a report groups its claims by it.
    `domain`: conditions on q, p, h and the parameters under which the verdict holds, one text each,
    beyond those of the claim itself; empty if it holds everywhere.
    `checked_by`: the checkers of the proof that decides it, one text each: the small checker, with
    the meaning of its certificate; Rocq, with its theorems; and, for an argument on paper, the
    number of its steps that a machine checked. Empty where nobody checked it.
    `proof`: the argument on paper beside the machine's checks, where there is one, as one
    paragraph; `steps`: the same step by step, with the checkers of each, after the assumptions in
    `given` and before a `remark`; other claims may have these two. `confirmed_by`: a second
    computation of the result, whose code shares nothing with this.
    `statement_id`: the statement of the paper of which the claim is a reading, `reading` the way it
    is read and `standing` its relation to the printed text; empty if statements are not counted.
    `repairs`: the statement in whose place this may be claimed, `repaired` the words, which are
    those of `statement` if empty, and `effect` what that changes in the paper.
    `reproduction`: a few lines of code that show the mistake in someone else's code; `severity`:
    the kind of mistake, where it is refuted: wrong order, not symplectic as claimed, wrong
    clock, embedded or step weights, digits that a double notices, digits below that, documentation.
    """

    id: str
    kind: str = ""
    source: str
    section: str = ""
    statement: ProseText
    statement_id: str = ""
    reading: ProseText = Prose("")
    standing: Standing = "fair"
    repairs: str = ""
    repaired: ProseText = Prose("")
    effect: Effect = ""
    scene: str
    verdict: Verdict
    evidence: ProseText
    checked_by: tuple[ProseText, ...] = ()
    domain: tuple[str, ...] = ()
    details: tuple[tuple[ProseText, ...], ...] = ()
    proof: ProseText = Prose("")
    given: ProseText = Prose("")
    steps: tuple[StepResult, ...] = ()
    remark: ProseText = Prose("")
    confirmed_by: str = ""
    reproduction: str = ""
    severity: str = ""


class Outcome(StrEnum):
    """The outcome of a statement, by all of its readings."""

    HOLDS = "holds"
    IN_SOME = "holds in some readings"
    REFUTED = "refuted"
    UNDECIDED = "undecided"


class Category(StrEnum):
    """The heading under which a statement is counted."""

    AS_MEANT = "holds as meant"
    MISPRINTED = "holds with a misprint"
    DEPENDS = "depends on the reading"
    REFUTED = "is refuted in every reading"
    UNDECIDED = "is undecided"

    def verb(self, count: int) -> str:
        """Return the words for that many statements: “hold as meant” for two."""
        singular, _, rest = self.partition(" ")
        plural = "are" if singular == "is" else singular.removesuffix("s")
        return f"{singular if count == 1 else plural} {rest}"


_CATEGORIES = {
    Outcome.HOLDS: Category.AS_MEANT,
    Outcome.IN_SOME: Category.DEPENDS,
    Outcome.REFUTED: Category.REFUTED,
    Outcome.UNDECIDED: Category.UNDECIDED,
}


class StatementResult(WithProse):
    """A statement of the paper; `readings` are the ids of its claims.

    `misprinted`: True if one of the readings is its letter, and the letter a misprint.
    """

    id: str
    source: str
    section: str = ""
    statement: ProseText
    outcome: Outcome
    readings: tuple[str, ...]
    misprinted: bool = False

    @property
    def category(self) -> Category:
        """The heading under which it is counted."""
        if self.outcome is Outcome.HOLDS and self.misprinted:
            return Category.MISPRINTED
        return _CATEGORIES[self.outcome]


def outcome_of(readings: Sequence[tuple[Verdict, Standing]]) -> Outcome:
    """Return the outcome of a statement by the verdicts and standings of its readings."""
    # The fair readings decide whether a statement holds as meant; see the module's text.
    fair = [verdict.holds for verdict, standing in readings if standing == "fair"]
    if fair and all(fair):
        return Outcome.HOLDS
    if any(verdict.holds for verdict, _ in readings):
        return Outcome.IN_SOME
    refuted = all(verdict is Verdict.REFUTED for verdict, _ in readings)
    return Outcome.REFUTED if refuted else Outcome.UNDECIDED


def statements_of(claims: Sequence[ClaimResult]) -> tuple[StatementResult, ...]:
    """Return the statements of which these claims are the readings, in their order."""
    readings: dict[str, list[ClaimResult]] = {}
    for claim in claims:
        if claim.statement_id:
            readings.setdefault(claim.statement_id, []).append(claim)
    return tuple(
        StatementResult(
            id=name,
            source=claims_of_statement[0].source,
            section=claims_of_statement[0].section,
            statement=claims_of_statement[0].statement,
            outcome=outcome_of([(claim.verdict, claim.standing) for claim in claims_of_statement]),
            readings=tuple(claim.id for claim in claims_of_statement),
            misprinted=any(claim.standing == "misprint" for claim in claims_of_statement),
        )
        for name, claims_of_statement in readings.items()
    )


def describe_counts(statements: Sequence[StatementResult], claims: Sequence[ClaimResult]) -> str:
    """Return a sentence with the numbers of statements in each category, and of readings."""
    counts = Counter(statement.category for statement in statements)
    readings, count = sum(len(each.readings) for each in statements), len(statements)
    parts = [f"{counts[c]} {c.verb(counts[c])}" for c in Category if counts[c]]
    ours = len(claims) - readings
    more = f"; {ours} more {'claims are' if ours > 1 else 'claim is'} ours" if ours else ""
    heading = f"{count} statement{'s' if count > 1 else ''} of the paper"
    return (
        f"{heading}, in {readings} reading{'s' if readings > 1 else ''}: {', '.join(parts)}{more}"
    )
