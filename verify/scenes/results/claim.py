"""What can be said of a claim, and of the paper's criteria: a verdict with its evidence."""

from typing import Literal

from verify.prose import Prose
from verify.scenes.frozen import Said, WithProse
from verify.verdict import Verdict

Standing = Literal["fair", "strict", "misprint", "ours"]  # see `verify.scenes.results.statement`


class StepResult(WithProse):
    """A step in words and formulas.

    `checked_by`: what checked it by machine, one text each; where there is none it was not checked
    by machine. `tried`: examples of it that were computed, which prove nothing by themselves.
    """

    text: Said
    checked_by: tuple[Said, ...] = ()
    tried: tuple[Said, ...] = ()


class CriterionResult(WithProse):
    """One of the paper's four criteria for one scheme in one scene."""

    number: int
    scheme: str
    verdict: Verdict
    evidence: Said


class ClaimResult(WithProse):
    """One claim with its verdict; `evidence` is one line, `details` a table of texts.

    `scene` is empty where the claim speaks of every H. `section` is where it stands in its paper,
    such as "4.1 The Duffing system"; a report groups its claims by it.
    `domain`: conditions on p, q, h and the parameters under which the verdict holds, one a text,
    beyond what the claim itself says; none where that is everywhere.
    `checked_by`: who checked the proof that decides it, one text each: the small checker, with what
    a certificate of it establishes; Rocq, with its theorems; and of an argument on paper how many
    of its steps a machine checked. None where nobody did.
    `proof`: the argument on paper that stands beside what the machine checked, where there is one,
    as one paragraph; `steps`: the same step by step, with who checked each, after what is `given`
    and before a `remark`, which other claims may have too. `confirmed_by`: what computes it again,
    with code that shares nothing with this.
    `statement_id`: of which statement of its paper it is a reading, `reading` how it is read there
    and `standing` how it stands to what is printed; empty where statements are not counted.
    `reproduction`: a few lines of code that show what is said of someone else's code; `severity`:
    what kind of mistake it is, where it is refuted: wrong order, not symplectic as claimed, wrong
    clock, embedded or step weights, digits that a double notices, digits below that, documentation.
    """

    id: str
    kind: str = ""
    source: str
    section: str = ""
    statement: Said
    statement_id: str = ""
    reading: Said = Prose("")
    standing: Standing = "fair"
    scene: str
    verdict: Verdict
    evidence: Said
    checked_by: tuple[Said, ...] = ()
    domain: tuple[str, ...] = ()
    details: tuple[tuple[Said, ...], ...] = ()
    proof: Said = Prose("")
    given: Said = Prose("")
    steps: tuple[StepResult, ...] = ()
    remark: Said = Prose("")
    confirmed_by: str = ""
    reproduction: str = ""
    severity: str = ""
