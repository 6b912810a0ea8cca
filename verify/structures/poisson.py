"""A Poisson structure, a bivector B(z) that may be degenerate: its defect is J B(z) Jᵀ − B(z')."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.lazy_sympy import sympy
from verify.structures.structure import StepValues, Structure, Value, accumulated_defect, is_zero
from verify.structures.symplectic import Entries


@dataclass(frozen=True)
class Poisson(Structure):
    """A bivector Σ B_ab ∂_a∧∂_b; `entries`: {z_a, z_b}, by a < b."""

    entries: Entries = field(default_factory=dict, hash=False)

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return "J B(z) Jᵀ − B(z')"

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return tuple(self.entries.values())

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        entries = {place: x.xreplace(values) for place, x in self.entries.items()}
        return Poisson(self.name, self.label, entries)

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        before = {place: step.before(x) for place, x in self.entries.items()}
        rows, result = step.jacobian, {}
        for a, b in combinations(range(len(step.names)), 2):
            total = step.number(Fraction(0))
            for (c, d), x in before.items():
                total = total + x * (rows[a][c] * rows[b][d] - rows[a][d] * rows[b][c])
            if (a, b) in self.entries:
                total = total - step.after(self.entries[a, b])
            result[f"{{{step.names[a]}, {step.names[b]}}}"] = total
        return result

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observable of a run that is its accumulated defect."""
        rows = self.matrix(len(names)).tolist()
        text = "; ".join(", ".join(map(to_text, row)) for row in rows)
        return (accumulated_defect(f"poisson = {text}"),)

    def matrix(self, size: int) -> sympy.Matrix:
        """Return B as an antisymmetric matrix."""
        matrix = sympy.zeros(size, size)
        for (a, b), x in self.entries.items():
            matrix[a, b], matrix[b, a] = x, -x
        return matrix

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        matrix, symbols = self.matrix(len(names)), [symbol(name) for name in names]
        for a, b, c in combinations(range(len(names)), 3):
            # Jacobi's identity: Σ over the cyclic orders of B_ad ∂_d B_bc.
            total = sympy.S.Zero
            for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
                for d, x in enumerate(symbols):
                    total += matrix[i, d] * matrix[j, k].diff(x)
            if is_zero(total, names) is not True:
                brackets = f"{names[a]}, {names[b]}, {names[c]}"
                return f"does not fulfil Jacobi's identity for {brackets}"
        return ""
