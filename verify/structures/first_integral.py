"""A first integral I of the flow, such as energy: its defect is I(z') − I(z)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from verify.algebra.expressions.formula_text import to_text
from verify.lazy_sympy import sympy
from verify.structures.structure import StepValues, Structure, Value


@dataclass(frozen=True)
class FirstIntegral(Structure):
    """A function of z, and perhaps of t, that is constant along every solution."""

    integral: sympy.Expr

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        letter = "H" if self.name == "energy" else "I"
        return f"{letter}(z') − {letter}(z)"

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return (self.integral,)

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        return FirstIntegral(self.name, self.label, self.integral.xreplace(values))

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observables of a run of its change, at the end and the greatest."""
        if self.name == "energy":
            return "energy_error", "energy_error_max"
        formula = to_text(self.integral)
        return f"integral_error: {formula}", f"integral_error_max: {formula}"

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        varying = {x.name for x in self.integral.free_symbols} & {*names, "t"}
        return "" if varying else "is a constant, which every step keeps"

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        return {"": step.after(self.integral) - step.before(self.integral)}
