"""Reversibility with respect to an involution ρ: the defect is ρΦ_hρΦ_h(z) − z."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.lazy_sympy import sympy
from verify.structures.structure import StepValues, Structure, Value, is_zero


@dataclass(frozen=True)
class Reversible(Structure):
    """An involution ρ, by coordinates, which turns the flow round: by default p ↦ −p."""

    reflection: tuple[sympy.Expr, ...]

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return "ρΦ_hρΦ_h(z) − z"

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return self.reflection

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        return Reversible(self.name, self.label, tuple(x.xreplace(values) for x in self.reflection))

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        return dict(zip(step.names, step.return_by(self.reflection), strict=True))

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observable that is the way back of a run."""
        return (f"way_back: {', '.join(map(to_text, self.reflection))}",)

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        if len(self.reflection) != len(names):
            return f"has {len(self.reflection)} formulas, and there are {len(names)} coordinates"
        images = {symbol(n): x for n, x in zip(names, self.reflection, strict=True)}
        for name, x in zip(names, self.reflection, strict=True):
            if is_zero(x.xreplace(images) - symbol(name), names) is not True:
                return f"is no involution: done twice it does not lead {name} back"
        return ""
