"""An integrator of another library as it is verified: its method, its driver, and its claims.

The floats of a library's table are read as the numbers for which they stand. A float that is the
rounding of a short quotient is read as this quotient: of a formula such as 35/384 in the source
only the float is left. Any other float stands for a number with more digits, so that nothing is
claimed of its digits.
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
Map = Callable[..., Any]  # a function of p, q, h, or of p, q, t, h, that returns p', q'
Point = tuple[Fraction, Fraction]  # p, q
_ROUNDING = Fraction(1, 2**51)
FINE = tuple(Fraction(k, 32) for k in (*range(48, 16, -2), *range(16, 3, -1)))


@dataclass(frozen=True)
class FloatStep:
    """One step in floats, (p, q, h) → (p', q'), for the Hamiltonian with the `formula`.

    If the formula has t, it is (p, q, t, h) → (p', q'). In several degrees of freedom p and q are
    arrays. `make`: imports the library and returns the step. `points`: the points at which it is
    tried, `ladder`: the step sizes, falling; () for the usual ones. A high order shows only between
    steps that are too large for it and steps whose error is rounding: few points and a fine ladder
    show more of it.
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
    """A Runge–Kutta method by its exact coefficients.

    `rounded`: True if they are the exact binary values of floats, so that conditions hold up to
    rounding only.
    """

    tableau: ImplicitTableau
    rounded: bool = False


@dataclass(frozen=True)
class FloatTable:
    """A table as `verify check-table` takes it, whose long numbers are floats."""

    entry: TableEntry


@dataclass(frozen=True)
class LibraryComparison:
    """A claim on a library as a whole.

    `compare`: returns the verdict, the evidence and a table. `kind`: the end of the claim's id.
    """

    statement: str
    compare: Callable[[], tuple[Verdict, str, tuple[tuple[str, ...], ...]]]
    kind: str = "agreement"


@dataclass(frozen=True)
class ReleasedIntegrator:
    """An integrator of a library, with its claims.

    `driven`: one sentence on how it is called as a one-step map. `source`: the place of its claims.
    `order`: the claimed order of convergence; `area_preserving`: True if it is claimed to be
    symplectic; None for no claim. For a force that depends on t the order is reported even without
    a claim. `reproduction`: a few lines of Python that show the finding with the library alone.
    `second_step`: the same method at a second problem, which has to confirm a refutation.
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
    """Build the integrator of one table, with the keys of its kind.

    Numbers stand in lists, as floats or as texts.
    """
    texts = {key: _texts(value) for key, value in keys.items() if value is not None}
    entry = kinds.get(kind).ENTRY.model_validate({"name": name, "kind": kind, **texts})
    return ReleasedIntegrator(name, driven, source, FloatTable(entry), reproduction=code)


def _texts(value: Any) -> Any:
    """Return numbers as texts, also within lists and arrays; any other value as it is."""
    if isinstance(value, str | bool | int):
        return value
    if isinstance(value, float) or (
        hasattr(value, "__float__") and not getattr(value, "shape", ())
    ):
        return text(float(value))
    return [_texts(float(x)) if isinstance(x, int) else _texts(x) for x in value]


def text(x: float) -> str:
    """Return the quotient with a short denominator that is x up to one rounding; if none is, x."""
    short = quotient(x)
    return repr(x) if short is None else str(short)


def quotient(x: float, digits: int = 5) -> Fraction | None:
    """Return the simplest quotient that is x up to one rounding; None if there is none.

    `digits`: the largest number of digits of its denominator.
    """
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
