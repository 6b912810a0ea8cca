"""The quantities of runs that claims compare, as balls, with their names in words."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Annotated, NamedTuple

from pydantic import AfterValidator

from verify import observables
from verify.arithmetic.arb import Ball, ball, format_ball, lg, midpoint_and_radius
from verify.errors import unknown_name
from verify.prose import Number, Prose, prose
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict


class ComparedNumber(NamedTuple):
    """A number that claims compare: its name in words, and how it is computed from a run."""

    label: str
    needs: tuple[str, ...]
    formula: Callable[..., Ball]

    def __call__(self, run: RunResult) -> Ball:
        return self.formula(*(ball(run.values[name]) for name in self.needs))


def _itself(value: Ball) -> Ball:
    return value


QUANTITIES = {
    **{n: ComparedNumber(each.label, (n,), _itself) for n, each in observables.by_name().items()},
    "lg_mse": ComparedNumber("lg MSE", ("mse",), lg),
    "lg_abs_lambda": ComparedNumber("lg |Λ|", ("lambda",), lambda end: lg(abs(end))),
    "abs_lambda": ComparedNumber("|Λ|", ("lambda",), abs),
    "mse_over_lambda": ComparedNumber(
        "MSE/|Λ|", ("mse", "lambda"), lambda mse, end: mse / abs(end)
    ),
}


# |Λ| and quotients have no sign, so that "less", "spread" and "depends" make sense for them.
_COMPARED = (
    *(name for name, each in observables.by_name().items() if not each.is_signed),
    *("abs_lambda", "mse_over_lambda"),
)


def _check_compared(name: str) -> str:
    if name not in _COMPARED:
        raise unknown_name("quantity", name, _COMPARED)
    return name


Quantity = Annotated[
    str, AfterValidator(_check_compared)
]  # that claims compare, none of them negative


class NoValueError(Exception):
    """A run that the claim needs ended without values; `reason` says which and how."""

    def __init__(self, run: RunResult) -> None:
        self.reason = end_of(run)
        super().__init__(self.reason)


def start_of(run: RunResult) -> Prose:
    """Format the run's initial value."""
    if not isinstance(run.q, str):
        return prose(f"q₀ = {run.start_text('q')}, p₀ = {run.start_text('p')}")
    return prose("q₀ = ", Number(run.q), ", p₀ = ", Number(run.start_text("p")))


def end_of(run: RunResult) -> Prose:
    """Describe how a run without values ended."""
    why = f"left the range at step {run.failed_step}" if run.failed_step else run.status
    return prose("the run from ", start_of(run), " with h = ", Number(run.step_size), f" {why}")


def table_of(rows: Sequence[Sequence[RunResult]], quantity: str) -> list[list[str]]:
    """Tabulate a quantity to five digits: a row per initial value, a column per step size."""
    head = ["initial value", *(f"h = {run.step_size}" for run in rows[0])]
    body = [
        [start_of(row[0]), *(format_ball(QUANTITIES[quantity](run), 5) for run in row)]
        for row in rows
    ]
    return [head, *body]


def middle(x: Ball) -> Fraction:
    """Return the exact midpoint of the ball."""
    return midpoint_and_radius(x)[0]


def sign(x: Ball, *, zero: bool | None = None) -> bool | None:
    """Return True if x is positive and False if it is negative.

    Returns `zero` if x is exactly 0, and None if its ball contains 0 and other numbers.
    """
    if x.is_zero():
        return zero
    return True if x > 0 else False if x < 0 else None


def all_hold(verdicts: Sequence[bool | None]) -> Verdict:
    """Return REFUTED if one is False, and MEASURED if all are True and there are any."""
    if False in verdicts:
        return Verdict.REFUTED
    return Verdict.UNDECIDED if None in verdicts or not verdicts else Verdict.MEASURED


def some_hold(verdicts: Sequence[bool | None]) -> Verdict:
    """Return MEASURED if one is True, and REFUTED if all are False and there are any."""
    if True in verdicts:
        return Verdict.MEASURED
    return Verdict.UNDECIDED if None in verdicts or not verdicts else Verdict.REFUTED
