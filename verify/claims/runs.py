"""The values of runs as balls: what claims about numbers compare, and how it is called."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Annotated, NamedTuple

from pydantic import AfterValidator

from verify import observables
from verify.arithmetic.arb import Ball, ball, lg, middle_and_radius, shown
from verify.errors import unknown
from verify.prose import Number, Prose, prose
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict


class Compared(NamedTuple):
    """A number that claims compare: its name in words, and what of a run it is made of."""

    label: str
    needs: tuple[str, ...]
    formula: Callable[..., Ball]

    def __call__(self, run: RunResult) -> Ball:
        return self.formula(*(ball(run.values[name]) for name in self.needs))


def _itself(value: Ball) -> Ball:
    return value


QUANTITIES = {
    **{n: Compared(each.label, (n,), _itself) for n, each in observables.by_name().items()},
    "lg_mse": Compared("lg MSE", ("mse",), lg),
    "lg_abs_lambda": Compared("lg |Λ|", ("lambda",), lambda end: lg(abs(end))),
    "abs_lambda": Compared("|Λ|", ("lambda",), abs),
    "mse_over_lambda": Compared("MSE/|Λ|", ("mse", "lambda"), lambda mse, end: mse / abs(end)),
}


_COMPARED = (
    *(name for name, each in observables.by_name().items() if not each.signed),
    *("abs_lambda", "mse_over_lambda"),
)


def _compared(name: str) -> str:
    if name not in _COMPARED:
        raise unknown("quantity", name, _COMPARED)
    return name


Quantity = Annotated[str, AfterValidator(_compared)]  # that claims compare, none of them negative


class NoValueError(Exception):
    """A run that the claim needs ended without values; `reason` says which and how."""

    def __init__(self, run: RunResult) -> None:
        self.reason = end_of(run)
        super().__init__(self.reason)


def start_of(run: RunResult) -> Prose:
    """The run's initial value."""
    if not isinstance(run.q, str):
        return prose(f"q₀ = {run.start_text('q')}, p₀ = {run.start_text('p')}")
    return prose("q₀ = ", Number(run.q), ", p₀ = ", Number(run.start_text("p")))


def end_of(run: RunResult) -> Prose:
    """How a run ended that has no values."""
    why = f"left the range at step {run.failed_step}" if run.failed_step else run.status
    return prose("the run from ", start_of(run), " with h = ", Number(run.step_size), f" {why}")


def table_of(rows: Sequence[Sequence[RunResult]], quantity: str) -> list[list[str]]:
    """A quantity of each run to five digits: a row an initial value, a column a step size."""
    head = ["initial value", *(f"h = {run.step_size}" for run in rows[0])]
    body = [
        [start_of(row[0]), *(shown(QUANTITIES[quantity](run), 5) for run in row)] for row in rows
    ]
    return [head, *body]


def middle(x: Ball) -> Fraction:
    """The middle of the ball, exactly."""
    return middle_and_radius(x)[0]


def sign(x: Ball, *, zero: bool | None = None) -> bool | None:
    """Whether x is positive (True) or negative (False); `zero` where it is exactly 0, and None
    where its ball holds 0 with other numbers."""
    if x.is_zero():
        return zero
    return True if x > 0 else False if x < 0 else None


def all_hold(verdicts: Sequence[bool | None]) -> Verdict:
    """REFUTED by one False; MEASURED where there is something to measure and all is True."""
    if False in verdicts:
        return Verdict.REFUTED
    return Verdict.UNDECIDED if None in verdicts or not verdicts else Verdict.MEASURED


def some_hold(verdicts: Sequence[bool | None]) -> Verdict:
    """MEASURED by one True; REFUTED where all is False."""
    if True in verdicts:
        return Verdict.MEASURED
    return Verdict.UNDECIDED if None in verdicts or not verdicts else Verdict.REFUTED
