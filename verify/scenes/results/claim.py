"""Results on claims and on the paper's criteria: a verdict with its evidence."""

from typing import Literal

from verify.prose import Prose
from verify.scenes.frozen import ProseText, WithProse
from verify.verdict import Verdict

Standing = Literal["fair", "strict", "misprint", "ours"]  # see `verify.scenes.results.statement`


class StepResult(WithProse):
    """A step of an argument, in words and formulas.

    `checked_by`: the machine checks of it, one text each; empty where there was none. `tried`:
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

    `scene` is empty where the claim is about every H. `section` is its place in the paper, such as
    "4.1 The Duffing system"; a report groups its claims by it.
    `domain`: conditions on q, p, h and the parameters under which the verdict holds, one text each,
    beyond those of the claim itself; empty where it holds everywhere.
    `checked_by`: the checkers of the proof that decides it, one text each: the small checker, with
    the meaning of its certificate; Rocq, with its theorems; and, for an argument on paper, the
    number of its steps that a machine checked. Empty where nobody checked it.
    `proof`: the argument on paper beside the machine's checks, where there is one, as one
    paragraph; `steps`: the same step by step, with the checkers of each, after the assumptions in
    `given` and before a `remark`; other claims may have these two. `confirmed_by`: a second
    computation of the result, whose code shares nothing with this.
    `statement_id`: the statement of the paper of which the claim is a reading, `reading` the way it
    is read and `standing` its relation to the printed text; empty where statements are not counted.
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
