"""A 2-form that each step multiplies by a factor c(h), as damping does: Jᵀω(z')J − c(h) ω(z)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.lazy_sympy import sympy
from verify.structures.structure import StepValues, Structure, Value, accumulated_defect, is_zero
from verify.structures.symplectic import Entries, SymplecticForm, form_defect, form_text


@dataclass(frozen=True)
class Conformal(Structure):
    """A 2-form, and the factor c by which the exact flow multiplies it in the time h."""

    factor: sympy.Expr
    entries: Entries = field(default_factory=dict, hash=False)

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return "Jᵀω(z')J − c(h) ω(z)"

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return (self.factor, *self.entries.values())

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        entries = {place: x.xreplace(values) for place, x in self.entries.items()}
        return Conformal(self.name, self.label, self.factor.xreplace(values), entries)

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        return form_defect(step, self.entries, step.factor(self.factor))

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observable of a run that is its accumulated defect."""
        form = form_text(self.entries, names)
        return (accumulated_defect(f"factor = {to_text(self.factor)}; form = {form}"),)

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        h = symbol("h")
        if is_zero(self.factor.subs(h, 0) - 1, ()) is not True:
            return "has a factor that is not 1 at h = 0"
        # A flow's factors are multiplied: c(h) = exp(κ h), so that c' = c'(0) c.
        slope = self.factor.diff(h)
        if is_zero(slope - slope.subs(h, 0) * self.factor, ("h",)) is not True:
            return "has a factor that is no exp(κ*h): a flow's factors are multiplied"
        return SymplecticForm(self.name, self.label, self.entries).mistake(names)
