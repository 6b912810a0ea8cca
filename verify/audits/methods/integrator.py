"""An integrator of others as it is verified: what it is, how it is driven, and what it claims."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.verdict import Verdict

Map = Callable[..., Any]  # of p, q, h, or of p, q, t, h; it returns p', q'
Point = tuple[Fraction, Fraction]  # p, q
FINE = tuple(Fraction(k, 32) for k in (*range(48, 16, -2), *range(16, 3, -1)))


@dataclass(frozen=True)
class FloatStep:
    """One step in floats, (p, q, h) → (p', q'), for one Hamiltonian, whose formula is given; where
    that has t in it, (p, q, t, h) → (p', q'). Of several degrees of freedom p and q are arrays.

    `make` imports the library and returns the step. `points`, `ladder`: where it is tried and with
    which steps, falling; else the usual. A high order shows between a step that is too large for it
    and one whose error is rounding: there, few points and a fine ladder tell more.
    """

    hamiltonian: str
    make: Callable[[], Map]
    points: tuple[tuple[Fraction, ...], ...] = ()
    ladder: tuple[Fraction, ...] = ()

    @property
    def exact(self) -> Hamiltonian:
        """The Hamiltonian H."""
        return Hamiltonian.parse(self.hamiltonian)


@dataclass(frozen=True)
class ExactTableau:
    """A Runge–Kutta method by its exact coefficients. `rounded`: they are floats, taken by their
    exact binary values, so that conditions hold up to rounding at best."""

    tableau: ImplicitTableau
    rounded: bool = False


@dataclass(frozen=True)
class Comparison:
    """A comparison as a whole: `compare` returns the verdict, the evidence and a table. `kind` ends
    the claim's id."""

    statement: str
    compare: Callable[[], tuple[Verdict, str, tuple[tuple[str, ...], ...]]]
    kind: str = "agreement"


@dataclass(frozen=True)
class ReleasedIntegrator:
    """`driven`: one sentence on how it is made a one-step map. `order`: the claimed order of
    convergence; `area_preserving`: whether it is claimed to be symplectic; None where nothing is
    claimed: of a force that depends on time the order is then told all the same. `source`: where.
    `reproduction`: a few lines of Python that show what was found with nothing but the library.
    `again`: the same at a second problem, which is asked before anything is held against it.
    """

    name: str
    driven: str
    source: str
    method: Any  # one of those above, a PrintedTable or a FloatTable: each is judged by its kind
    order: int | None = None
    area_preserving: bool | None = None
    reproduction: str = ""
    again: FloatStep | None = None
