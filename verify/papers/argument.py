"""Theorems of papers, each with its verdict, its proof in numbered steps, and the checks behind it.

A check is one exact fact: polynomials that vanish, equal formulas, or numbers that were compared. A
step is marked with what checked it in full: exact algebra or enclosures of this run, which are rows
of the argument's table, or theorems of the shipped theory for Rocq. A step that is only tried on
examples, or stands on paper alone, counts as not checked by machine.

The words of a module's arguments stand in the Markdown file beside it, each below the name of its
function, and their steps name the checks that the function computes (`ArgumentTexts`):

    ## eq_0

    The verdict's evidence, in the syntax of `read_prose`, with formulas quoted, and {value}.

    The setting and notation, if there is any to say.

    - A step in so many words. [first_check, Theorems.a_theorem; tried examples]
    - A step that a reader has to follow.
    - [steps_of_another_text]

    A remark after the proof, if there is one.

A name with a point is a theorem of the shipped theory for Rocq; the others are arguments of the
call: a check, several, or the steps that stand there; and texts, which take the places of their
names in braces, as another text of the file does.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from pathlib import Path
from typing import Any

import sympy

from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.proof.assistant.shipped_theory import ShippedTheorem
from verify.prose import Formula, Prose, count, join_prose, prose, read_prose
from verify.scenes.frozen import ProseText, WithProse
from verify.scenes.results.claim import StepResult
from verify.verdict import Verdict

ALGEBRA = "exact algebra"
NUMBERS = "exact numbers"
BALLS = "enclosures"
_PARAGRAPH_END = re.compile(r"\n\s*\n")
_ITEM = re.compile(r"^\s*- ", re.MULTILINE)
_HEADING = re.compile(r"^## (\w+)$", re.MULTILINE)
_LIST = r"[\w.]+(?:, [\w.]+)*"
_MARKS = re.compile(rf"(.*?) ?(?:\[({_LIST})?(?:;? ?tried ({_LIST}))?\])?")  # at a step's end
_NAME = re.compile(r"[\w.]+")


@dataclass(frozen=True)
class Check:
    """One exact fact on which an argument rests.

    `statement` says it, `value` is the result in a few words, and `method` that of the check; these
    texts are in the syntax of `read_prose`, with formulas quoted.
    """

    statement: str
    holds: bool
    value: str
    method: str = ALGEBRA


def vanishes(statement: str, *elements: Any) -> Check:
    """Check that polynomials in normal form are zero."""
    wrong = [x for x in elements if x != 0]
    return Check(statement, not wrong, f"{len(wrong[0])} terms are left" if wrong else "0")


def same(
    statement: str, gaps: Sequence[sympy.Expr], names: Sequence[str], value: str = "0"
) -> Check:
    """Check that all differences, formulas in these names, are zero in one exact ring.

    `value`: what the check shows if they are.
    """
    # One ring for all formulas: `ring.decide` may then use relations between their functions.
    ring, elements = embed(gaps, names)
    wrong = [gap for gap, x in zip(gaps, elements, strict=True) if ring.decide(x).zero is not True]
    return Check(statement, not wrong, f"`{to_text(wrong[0])}`" if wrong else value)


Checks = Check | Iterable["Check | ShippedTheorem | Step"]


# -- arguments ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Step:
    """One step of an argument.

    `by`: the checks that verify it in full by machine, none if a reader has to follow it; `tried`:
    examples of it that were computed.
    """

    text: str
    by: tuple[Check | ShippedTheorem, ...] = ()
    tried: tuple[Check, ...] = ()


def steps(text: str, **checks: Checks) -> list[Step]:
    """Read the steps of a list, and the checks that they name; ValueError if one is not named."""
    result: list[Step] = []
    names: set[str] = set()
    for item in _ITEM.split(text.strip())[1:]:
        words, by, tried = _MARKS.fullmatch(" ".join(item.split())).groups()  # type: ignore[union-attr]
        names |= set(_NAME.findall(f"{by or ''}, {tried or ''}"))
        values, examples = _checks(by, checks), _checks(tried, checks)
        if words:
            result.append(Step(words, tuple(values), tuple(examples)))
        else:
            result += values
    if unnamed := checks.keys() - names:
        raise ValueError(f"no step names {', '.join(sorted(unnamed))}")
    return result


def _checks(names: str | None, checks: Mapping[str, Checks]) -> list[Any]:
    """Return the checks, theorems or steps of these names, in their order."""
    values: list[Any] = []
    for name in _NAME.findall(names or ""):
        value = ShippedTheorem(*name.split(".")) if "." in name else checks[name]
        values += [value] if isinstance(value, (Check, ShippedTheorem)) else value
    return values


class Argument(WithProse):
    """A verdict on a claim's statement, and the argument for it.

    `evidence` is one line; `given`: the setting and notation of the steps; `remark`: a comment
    after the proof; `proof`: all of it in one paragraph that can be quoted; `details`: a table of
    the computed facts, whose first row is its head. `checked_by`: how many steps a machine checked.
    """

    verdict: Verdict
    evidence: ProseText
    given: ProseText
    steps: tuple[StepResult, ...]
    remark: ProseText
    details: tuple[tuple[ProseText, ...], ...]
    checked_by: tuple[ProseText, ...]

    @property
    def proof(self) -> Prose:
        """The whole argument as a paragraph; empty if it shows nothing."""
        if not self.steps:
            return Prose()
        texts = [self.given, *(result.text for result in self.steps)]
        return join_prose(" ", [*filter(None, texts), "∎", *filter(None, [self.remark])])


HEAD = ("what the argument rests on", "value", "checked")


def _argument(
    verdict: Verdict, evidence: str, steps: Iterable[Step], *, setting: str = "", remark: str = ""
) -> Argument:
    """Build the argument if every check holds; otherwise it shows nothing, and is UNDECIDED.

    A wrong counterexample refutes nothing, and a proof with a wrong step proves nothing. All texts
    are in the syntax of `read_prose`, with formulas quoted. The checks are those that the steps
    name, in their order.
    """
    steps = tuple(steps)
    # Equal checks of several steps are one row of the table.
    checks = checks_of(steps)
    rows = [(c.statement, c.value, "holds" if c.holds else "does not hold") for c in checks]
    failures = [c for c in checks if not c.holds]
    # An argument without any check would be prose alone, which this toolkit does not vouch for.
    if failures or not checks:
        verdict, steps = Verdict.UNDECIDED, ()
        evidence = (
            f"the argument fails at: {failures[0].statement}" if failures else "nothing was checked"
        )
    return Argument(
        verdict=verdict,
        evidence=_read(evidence),
        given=_read(setting),
        steps=tuple(_result(argument_step, checks) for argument_step in steps),
        remark=_read(remark),
        details=tuple(tuple(map(read_prose, row)) for row in (HEAD, *rows)),
        checked_by=(_count_steps(steps),) if steps else (),
    )


def _read_argument(verdict: Verdict, text: str, /, **checks: Checks) -> Argument:
    """Build the argument of a text as the head of this file shows it."""
    evidence, *others = _PARAGRAPH_END.split(text.strip())
    at = next(k for k, paragraph in enumerate(others) if _ITEM.match(paragraph))
    setting, remark = " ".join(others[:at]), " ".join(others[at + 1 :])
    return _argument(verdict, evidence, steps(others[at], **checks), setting=setting, remark=remark)


class ArgumentTexts:
    """The words of a module's arguments, in the Markdown file beside the module."""

    def __init__(self, module_file: str) -> None:
        self._path = Path(module_file).with_suffix(".md")

    def proof(self, name: str, /, **checks: Checks | str) -> Argument:
        """Return the argument below this heading, with the verdict PROVED if all checks hold."""
        text, other_checks = self._fill(name, checks)
        return _read_argument(Verdict.PROVED, text, **other_checks)

    def refutation(self, name: str, /, **checks: Checks | str) -> Argument:
        """Return the argument below this heading, with the verdict REFUTED if all checks hold."""
        text, other_checks = self._fill(name, checks)
        return _read_argument(Verdict.REFUTED, text, **other_checks)

    def steps(self, name: str, /, **checks: Checks | str) -> list[Step]:
        """Return the steps below this heading, for an argument that several have in common."""
        text, other_checks = self._fill(name, checks)
        return steps(text, **other_checks)

    @cached_property
    def _texts(self) -> dict[str, str]:
        parts = _HEADING.split(self._path.read_text(encoding="utf-8"))[1:]
        return {name: text.strip() for name, text in zip(parts[::2], parts[1::2], strict=True)}

    def _fill(self, name: str, checks: Mapping[str, Checks | str]) -> tuple[str, dict[str, Checks]]:
        """Return the text, with other texts in the places of their names, and the checks."""
        text = self._texts[name]
        values = {key: value for key, value in checks.items() if isinstance(value, str)}
        if unnamed := [key for key in values if f"{{{key}}}" not in text]:
            raise ValueError(f"{name} has no place for {', '.join(unnamed)}")
        for key, value in (self._texts | values).items():
            text = text.replace(f"{{{key}}}", value)
        return text, {key: x for key, x in checks.items() if not isinstance(x, str)}


def checks_of(steps: Iterable[Step]) -> list[Check]:
    """Return all checks that the steps rest on or were tried by, each once."""
    checks = [
        c
        for argument_step in steps
        for c in (*argument_step.by, *argument_step.tried)
        if isinstance(c, Check)
    ]
    return list(dict.fromkeys(checks))


# -- marks ----------------------------------------------------------------------------------------


def _result(argument_step: Step, checks: Sequence[Check]) -> StepResult:
    checks_of_step = [x for x in argument_step.by if isinstance(x, Check)]
    theorems = [Formula(str(x)) for x in argument_step.by if isinstance(x, ShippedTheorem)]
    rocq = [prose("Rocq, ", join_prose(", ", theorems))] if theorems else []
    return StepResult(
        text=_read(argument_step.text),
        checked_by=(*_rows(checks_of_step, checks), *rocq),
        tried=tuple(_rows(argument_step.tried, checks)),
    )


def _rows(chosen: Sequence[Check], checks: Sequence[Check]) -> list[Prose]:
    """Describe how these checks were made, and in which rows of the table they stand."""
    rows: dict[str, list[int]] = {}
    for number, check in enumerate(checks, start=1):
        if check in chosen:
            rows.setdefault(check.method, []).append(number)
    return [prose(f"{method}, {_format_rows(numbers)}") for method, numbers in rows.items()]


def _format_rows(numbers: Sequence[int]) -> str:
    """Format row numbers as `row 3`, or `rows 1–4 and 7`."""
    parts: list[str] = []
    # Numbers that follow each other have the same difference to their index.
    for _, run in groupby(enumerate(numbers), key=lambda pair: pair[1] - pair[0]):
        numbers_in_run = [n for _, n in run]
        parts.append(
            f"{numbers_in_run[0]}"
            if len(numbers_in_run) == 1
            else f"{numbers_in_run[0]}–{numbers_in_run[-1]}"
        )
    return f"row{'s' if len(numbers) > 1 else ''} {' and '.join(parts)}"


def _count_steps(steps: Sequence[Step]) -> Prose:
    checked = sum(1 for argument_step in steps if argument_step.by)
    marks = "all checked by machine"
    if checked < len(steps):
        marks = f"{checked or 'none'} checked by machine, {len(steps) - checked} not"
    return prose(f"by hand: an argument in {count(len(steps), 'step')}, {marks}")


def _read(text: str) -> Prose:
    return read_prose(" ".join(text.split()))
