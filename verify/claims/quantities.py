"""The quantities of runs that claims compare, as balls, and the printed decimals beside them.

A printed decimal is right if the value's whole ball rounds to it. A value on the border of two
roundings counts for both. If only a part of the ball rounds to the decimal, the answer is
UNDECIDED.
"""

import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator, BeforeValidator, Field

from verify import observables
from verify.arithmetic.arb import (
    Ball,
    ball,
    bounds,
    format_ball,
    format_fixed,
    is_representable,
    lg,
    midpoint_and_radius,
)
from verify.errors import InputError, unknown_name
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
    **{
        n: ComparedNumber(observable.label, (n,), _itself)
        for n, observable in observables.by_name().items()
    },
    "lg_mse": ComparedNumber("lg MSE", ("mse",), lg),
    "lg_abs_lambda": ComparedNumber("lg |Λ|", ("lambda",), lambda lam: lg(abs(lam))),
    "abs_lambda": ComparedNumber("|Λ|", ("lambda",), abs),
    "mse_over_lambda": ComparedNumber(
        "MSE/|Λ|", ("mse", "lambda"), lambda mse, lam: mse / abs(lam)
    ),
}


# |Λ| and quotients have no sign, so that "less", "spread" and "depends" make sense for them.
_COMPARED = (
    *(name for name, observable in observables.by_name().items() if not observable.is_signed),
    *("abs_lambda", "mse_over_lambda"),
)


def _check_compared(name: str) -> str:
    if name not in _COMPARED:
        raise unknown_name("quantity", name, _COMPARED)
    return name


# The name of a quantity that claims compare, none of them negative.
Quantity = Annotated[str, AfterValidator(_check_compared)]


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
    ending = f"left the range at step {run.failed_step}" if run.failed_step else run.status
    return prose("the run from ", start_of(run), " with h = ", Number(run.step_size), f" {ending}")


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


# -- printed decimals -----------------------------------------------------------------------------

_PRINTED = re.compile(r"-?\d{1,20}(\.\d{1,1000})?(e[+-]?\d{1,3})?", re.ASCII)


def _normalize(value: Any) -> str:
    """Normalize a number as a paper prints it; TOML's decimals are texts already."""
    # TOML has already turned decimals into texts; a bool is an int in Python and no number here.
    text = str(value) if isinstance(value, int) and not isinstance(value, bool) else value
    if isinstance(text, str):
        text = text.strip().replace("\N{MINUS SIGN}", "-").replace("E", "e")
        if _PRINTED.fullmatch(text):
            return text
    raise InputError("number", value, "is not a printed decimal, such as -7.3010 or 1.53e-17")


PrintedDecimal = Annotated[str, BeforeValidator(_normalize)]
PrintedRow = Annotated[tuple[PrintedDecimal, ...], Field(min_length=1, max_length=1000)]


MORE_DIGITS = 3  # of a value beside a printed one, beyond those that are printed
# How a value stands to a printed one, by the answer of `rounds_to`.
ROUNDING = {
    True: "which rounds to",
    False: "which does not round to",
    None: "not known to round to",
}


def holds(run: RunResult, quantity: str, printed: str) -> bool | None:
    """Return True if the run's value rounds to the printed one; None if only in part."""
    source = run.values[QUANTITIES[quantity].needs[0]]
    if quantity.startswith("lg") and Fraction(source.value) == Fraction(source.bound) == 0:
        return False  # lg 0 is no number
    return rounds_to(QUANTITIES[quantity](run), printed)


def places(printed: str) -> int:
    """Return the number of decimals: the unit of the last digit is 10^−places."""
    mantissa, _, exponent = printed.partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)


def rounds_to(value: Ball, printed: str) -> bool | None:
    """Return True if the whole ball rounds to the printed decimal; None if only a part does."""
    if not is_representable(value):
        return None
    # A number rounds to the printed one if it differs by at most half a unit of the last digit;
    # the border counts, since papers round halves either way.
    half = Fraction(10) ** -places(printed) / 2
    low, high = bounds(value)
    if abs(low - Fraction(printed)) <= half and abs(high - Fraction(printed)) <= half:
        return True
    return None if low - half <= Fraction(printed) <= high + half else False


def format_value(run: RunResult, quantity: str, digits: int) -> str:
    """Format the run's value of a quantity to so many digits."""
    value = QUANTITIES[quantity](run)
    if quantity.startswith("lg"):
        return format_fixed(value, max(1, digits - 2)) if is_representable(value) else "unknown"
    return format_ball(value, digits)


def cell(run: RunResult, quantity: str, places: int) -> str:
    """Format the value for a table: a logarithm to so many decimals."""
    value = QUANTITIES[quantity](run)
    return format_fixed(value, max(1, places)) if quantity.startswith("lg") else format_ball(value)


def short(value: Ball, quantity: str) -> str:
    """Format the value to a few digits."""
    return format_fixed(value, 2) if quantity.startswith("lg") else format_ball(value, 3)
