"""An integrator of others as it is verified: what it is, how it is driven, and what it claims.

A table that a library holds as floats is read as the numbers that they stand for. A float that is a
short quotient but for its own rounding is that quotient: of a formula such as 35/384 in a source
nothing else is left. Any other stands for a number that its digits are rounded from, so that of
digits nothing is claimed.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tables import kinds
from verify.integrators.tables.entry import TableEntry
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.verdict import Verdict

NOT_CLAIMED = "Nothing is claimed of symplecticity"
Map = Callable[..., Any]  # of p, q, h, or of p, q, t, h; it returns p', q'
Point = tuple[Fraction, Fraction]  # p, q
_ROUNDING = Fraction(1, 2**51)
FINE = tuple(Fraction(k, 32) for k in (*range(48, 16, -2), *range(16, 3, -1)))


@dataclass(frozen=True)
class FloatStep:
    """One step in floats, (p, q, h) → (p', q'), for one Hamiltonian by its `formula`; where
    that has t in it, (p, q, t, h) → (p', q'). Of several degrees of freedom p and q are arrays.

    `make` imports the library and returns the step. `points`, `ladder`: where it is tried and with
    which steps, falling; else the usual. A high order shows between a step that is too large for it
    and one whose error is rounding: there, few points and a fine ladder tell more.
    """

    formula: str
    make: Callable[[], Map]
    points: tuple[tuple[Fraction, ...], ...] = ()
    ladder: tuple[Fraction, ...] = ()

    @property
    def hamiltonian(self) -> Hamiltonian:
        """The Hamiltonian H."""
        return Hamiltonian.parse(self.formula)


@dataclass(frozen=True)
class ExactTableau:
    """A Runge–Kutta method by its exact coefficients. `rounded`: they are floats, taken by their
    exact binary values, so that conditions hold up to rounding at best."""

    tableau: ImplicitTableau
    rounded: bool = False


@dataclass(frozen=True)
class FloatTable:
    """A table as `verify check-table` takes it, whose long numbers are floats."""

    entry: TableEntry


@dataclass(frozen=True)
class LibraryComparison:
    """A comparison as a whole: `compare` returns the verdict, the evidence and a table. `kind` ends
    the claim's id."""

    statement: str
    compare: Callable[[], tuple[Verdict, str, tuple[tuple[str, ...], ...]]]
    kind: str = "agreement"


@dataclass(frozen=True)
class ReleasedIntegrator:
    """An integrator of a library, with what it claims.

    `driven`: one sentence on how it is made a one-step map. `order`: the claimed order of
    convergence; `area_preserving`: whether it is claimed to be symplectic; None if nothing is
    claimed: of a force that depends on time the order is then told all the same. `source`: where.
    `reproduction`: a few lines of Python that show what was found with nothing but the library.
    `second_step`: the same at a second problem, which is asked before anything is held against it.
    """

    name: str
    driven: str
    source: str
    method: Any  # one of those above, or a PrintedTable: each is judged by its kind
    order: int | None = None
    area_preserving: bool | None = None
    reproduction: str = ""
    second_step: FloatStep | None = None


# -- tables of floats ------------------------------------------------------------------------------


def table_integrator(
    name: str, kind: str, driven: str, source: str, code: str = "", **keys: Any
) -> ReleasedIntegrator:
    """Build the integrator of one table, with the keys of its kind; numbers in lists, of floats or
    as texts."""
    texts = {key: _texts(value) for key, value in keys.items() if value is not None}
    entry = kinds.get(kind).ENTRY.model_validate({"name": name, "kind": kind, **texts})
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
    short = quotient(x)
    return repr(x) if short is None else str(short)


def quotient(x: float, digits: int = 5) -> Fraction | None:
    """Return the quotient of the smallest denominator, of so many digits at most, that rounds to x
    but for one unit; None if there is none."""
    value = Fraction(x)
    for n in range(1, digits + 1):
        # Short denominators first: of several quotients that round to x the simplest is meant.
        short = value.limit_denominator(10**n)
        if abs(short - value) <= _ROUNDING * max(Fraction(1), abs(value)):
            return short
    return None


def full(rows: Iterable[Iterable[float]], stages: int) -> list[list[float]]:
    """Fill the rows of a lower triangle with zeros, to as many entries as there are stages."""
    padded = [([*map(float, row)] + [0.0] * stages)[:stages] for row in rows]
    return padded[:stages]
