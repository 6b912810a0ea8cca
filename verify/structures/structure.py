"""A structure T that a step may keep: Φ*T = T, or c·T; and the values of which its defect is made.

The defect of one step is written once for each structure, in the operations of `StepValues`, and
read as series in h, as elements of a ring, in balls, or in floats.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from verify.lazy_sympy import sympy

Value = Any  # has sums, differences and products: a series, a ring element, a ball, a float


class StepValues(Protocol):
    """The values at z, where a step begins, and at z' = Φ_h(z), where it ends.

    Formulas are of the coordinates, of t if the system depends on it, and of parameters.
    """

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the coordinates."""

    def number(self, x: Fraction) -> Value:
        """Return a constant."""

    def before(self, formula: sympy.Expr) -> Value:
        """Return a formula's value at (z, t)."""

    def after(self, formula: sympy.Expr) -> Value:
        """Return a formula's value at (z', t + h)."""

    def factor(self, formula: sympy.Expr) -> Value:
        """Return the value of a formula in h and parameters alone."""

    @property
    def jacobian(self) -> Sequence[Sequence[Value]]:
        """The Jacobian J = ∂z'/∂z by rows."""

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> Sequence[Value]:
        """Return Ψ(z') − z by coordinates: Ψ = Φ_(−h), or ρ∘Φ_h∘ρ with a `reflection` ρ."""


@dataclass(frozen=True)
class Structure(ABC):
    """A structure that a step may keep.

    `name`: its name on the command line and in results; `label`: what pages and messages call it.
    """

    name: str
    label: str

    @property
    @abstractmethod
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""

    @abstractmethod
    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""

    def total_defect(self, steps: StepValues) -> Sequence[Value]:
        """Return the components of the defect that has accumulated over steps, which are one map:
        `steps` has its values."""
        return [*self.defect(steps).values()]

    @abstractmethod
    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observables of a run, by their names, of what has accumulated at its end and,
        if it is measured, of the greatest on the way; `names`: the coordinates."""

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure on these coordinates; "" if nothing does.

        It is a property of the formulas alone; that the exact flow keeps the structure is checked
        elsewhere.
        """
        return ""

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return ()

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        return self


def accumulated_defect(text: str) -> str:
    """Return the name of the observable of a text that `verify.structures.accumulated` reads."""
    return f"accumulated_defect: {text}"


def is_zero(x: sympy.Expr, names: Sequence[str]) -> bool | None:
    """Return True if an expression is shown to be the zero function; None if undecided."""
    from verify.algebra.embedding import embed

    symbols = sorted({s.name for s in x.free_symbols} - {*names})
    ring, (element,) = embed([x], [*names, *symbols])
    return ring.vanishes(element)
