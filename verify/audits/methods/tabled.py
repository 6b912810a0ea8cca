"""Tables that libraries hold as floats, read as the numbers that they stand for.

A float that is a short quotient but for its own rounding is that quotient: of a formula such as
35/384 in a source nothing else is left. Any other stands for a number that its digits are rounded
from, so that of digits nothing is claimed.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.audits.methods.integrator import ReleasedIntegrator
from verify.integrators.tables import kinds
from verify.integrators.tables.entry import TableEntry

_ROUNDING = Fraction(1, 2**51)


@dataclass(frozen=True)
class FloatTable:
    """A table as `verify check-table` takes it, whose long numbers are floats."""

    entry: TableEntry


def table_integrator(
    name: str, kind: str, driven: str, source: str, code: str = "", **keys: Any
) -> ReleasedIntegrator:
    """Build the integrator of one table, with the keys of its kind; numbers in lists, of floats or
    as texts."""
    texts = {key: _texts(value) for key, value in keys.items() if value is not None}
    entry = kinds.get(kind).Entry.model_validate({"name": name, "kind": kind, **texts})
    return ReleasedIntegrator(name, driven, source, FloatTable(entry), reproduction=code)


def _texts(value: Any) -> Any:
    """Return numbers as texts, within lists and arrays; the rest as it is."""
    if isinstance(value, str | bool | int):
        return value
    if isinstance(value, float) or (
        hasattr(value, "__float__") and not getattr(value, "shape", ())
    ):
        return text(float(value))
    return [_texts(float(x)) if isinstance(x, int) else _texts(x) for x in value]


def text(x: float) -> str:
    """Return the quotient of a short denominator that rounds to x, but for one unit; else x."""
    near = quotient(x)
    return repr(x) if near is None else str(near)


def quotient(x: float, digits: int = 5) -> Fraction | None:
    """Return the quotient of the smallest denominator, of so many digits at most, that rounds to x
    but for one unit; None where there is none."""
    exact = Fraction(x)
    for n in range(1, digits + 1):
        # Short denominators first: of several quotients that round to x the simplest is meant.
        near = exact.limit_denominator(10**n)
        if abs(near - exact) <= _ROUNDING * max(Fraction(1), abs(exact)):
            return near
    return None


def full(rows: Iterable[Iterable[float]], stages: int) -> list[list[float]]:
    """Fill the rows of a lower triangle with zeros, to as many entries as there are stages."""
    padded = [([*map(float, row)] + [0.0] * stages)[:stages] for row in rows]
    return padded[:stages]
