"""A theorem of a paper with its verdict, its proof in numbered steps, and what a machine checked.

A step is marked with what checked it in full: exact algebra or enclosures of this run, which are
rows of the argument's table, or theorems of the shipped theory for Rocq. What is only tried on
examples, or stands on paper alone, counts as not checked by machine.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby

from verify.papers.checks.check import Check
from verify.proof.assistant.stated import Shipped
from verify.prose import Formula, Prose, count, joined, prose, read_prose
from verify.scenes.frozen import Said, WithProse
from verify.scenes.results.claim import StepResult
from verify.verdict import Verdict


@dataclass(frozen=True)
class Step:
    """One step of an argument: `by` what it was checked by machine in full, none for one that a
    reader has to follow; `tried`: examples of it that were computed."""

    text: str
    by: tuple[Check | Shipped, ...] = ()
    tried: tuple[Check, ...] = ()


def step(text: str, *by: Check | Shipped, tried: Sequence[Check] = ()) -> Step:
    """The step with this text, as `read_prose` takes it, checked by these."""
    return Step(text, by, tuple(tried))


class Argument(WithProse):
    """A verdict on what a claim states, and the argument for it.

    `evidence` is one line; `given` what the steps speak of, `remark` what follows the proof and
    needs none; `proof` all of it in one paragraph that can be quoted; `details` a table, whose
    first row is its head: the facts that were computed. `checked_by`: how many steps a machine
    checked.
    """

    verdict: Verdict
    evidence: Said
    given: Said
    steps: tuple[StepResult, ...]
    remark: Said
    details: tuple[tuple[Said, ...], ...]
    checked_by: tuple[Said, ...]

    @property
    def proof(self) -> Prose:
        """The whole argument as a paragraph; empty where it shows nothing."""
        if not self.steps:
            return Prose()
        texts = [self.given, *(each.text for each in self.steps)]
        return joined(" ", [*filter(None, texts), "∎", *filter(None, [self.remark])])


HEAD = ("what the argument rests on", "value", "checked")


def _argument(
    verdict: Verdict,
    evidence: str,
    steps: Iterable[Step],
    *,
    given: str = "",
    remark: str = "",
) -> Argument:
    """The argument, where every check holds; else it shows nothing, and is UNDECIDED.

    A wrong counterexample refutes nothing, and a proof with a wrong step proves nothing. All texts
    are written as `read_prose` takes them, with formulas quoted. What is checked are the checks
    that the steps name, in their order.
    """
    steps = tuple(steps)
    checks = checks_of(steps)
    rows = [(c.what, c.shown, "holds" if c.holds else "does not hold") for c in checks]
    failed = [c for c in checks if not c.holds]
    if failed or not checks:
        verdict, steps = Verdict.UNDECIDED, ()
        evidence = f"the argument fails at: {failed[0].what}" if failed else "nothing was checked"
    return Argument(
        verdict=verdict,
        evidence=read_prose(evidence),
        given=_read(given),
        steps=tuple(_result(each, checks) for each in steps),
        remark=_read(remark),
        details=tuple(tuple(map(read_prose, row)) for row in (HEAD, *rows)),
        checked_by=(_counted(steps),) if steps else (),
    )


proof = partial(_argument, Verdict.PROVED)
refutation = partial(_argument, Verdict.REFUTED)


def checks_of(steps: Iterable[Step]) -> list[Check]:
    """All that the steps rest on or were tried by, each once."""
    found = [c for each in steps for c in (*each.by, *each.tried) if isinstance(c, Check)]
    return list(dict.fromkeys(found))


# -- marks ----------------------------------------------------------------------------------------


def _result(found: Step, checks: Sequence[Check]) -> StepResult:
    own = [x for x in found.by if isinstance(x, Check)]
    theorems = [Formula(str(x)) for x in found.by if isinstance(x, Shipped)]
    rocq = [prose("Rocq, ", joined(", ", theorems))] if theorems else []
    return StepResult(
        text=_read(found.text),
        checked_by=(*_rows(own, checks), *rocq),
        tried=tuple(_rows(found.tried, checks)),
    )


def _rows(own: Sequence[Check], checks: Sequence[Check]) -> list[Prose]:
    """How these are known, and in which rows of the table they stand."""
    rows: dict[str, list[int]] = {}
    for number, check in enumerate(checks, start=1):
        if check in own:
            rows.setdefault(check.how, []).append(number)
    return [prose(f"{how}, {_named(numbers)}") for how, numbers in rows.items()]


def _named(numbers: Sequence[int]) -> str:
    """`row 3`, or `rows 1–4 and 7`."""
    parts: list[str] = []
    for _, run in groupby(enumerate(numbers), key=lambda each: each[1] - each[0]):
        found = [n for _, n in run]
        parts.append(f"{found[0]}" if len(found) == 1 else f"{found[0]}–{found[-1]}")
    return f"row{'s' if len(numbers) > 1 else ''} {' and '.join(parts)}"


def _counted(steps: Sequence[Step]) -> Prose:
    checked = sum(1 for each in steps if each.by)
    how = "all checked by machine"
    if checked < len(steps):
        how = f"{checked or 'none'} checked by machine, {len(steps) - checked} not"
    return prose(f"paper: an argument in {count(len(steps), 'step')}, {how}")


def _read(text: str) -> Prose:
    return read_prose(" ".join(text.split()))
