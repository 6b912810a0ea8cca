"""Volume ρ dz, with a density ρ(z) that is 1 by default: its defect is ρ(z') det J − ρ(z)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.algebra.expressions.formula_text import to_text
from verify.errors import LimitError
from verify.lazy_sympy import sympy
from verify.structures.structure import StepValues, Structure, Value, accumulated_defect, is_zero

_MOST_MINORS = 15_000  # of 16 rows there are 12,870 at most


@dataclass(frozen=True)
class Volume(Structure):
    """Volume with a density, in any number of coordinates."""

    density: sympy.Expr

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return "ΔJ = det J − 1" if self.density == 1 else "ρ(z') det J − ρ(z)"

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return (self.density,)

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        return Volume(self.name, self.label, self.density.xreplace(values))

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        volume = step.after(self.density) * determinant(step.jacobian)
        return {"": volume - step.before(self.density)}

    def total_defect(self, steps: StepValues) -> Sequence[Value]:
        """Return the accumulated defect relative to the density at the start, as Λ is."""
        share = steps.after(self.density) / steps.before(self.density)
        return [share * determinant(steps.jacobian) - steps.number(Fraction(1))]

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observables of a run of the accumulated defect: at its end, with the density 1
        the greatest too."""
        if self.density == 1:
            return "lambda", "lambda_max"
        return (accumulated_defect(f"density = {to_text(self.density)}"),)

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        return "vanishes everywhere" if is_zero(self.density, names) is not False else ""


def determinant(matrix: Sequence[Sequence[Value]]) -> Value:
    """Return the determinant by its minors of the first k rows, k = 1, 2, …, without division.

    Raises LimitError where too many minors are not 0.
    """
    size = len(matrix)
    minors: dict[tuple[int, ...], Value] = {(k,): x for k, x in enumerate(matrix[0]) if x != 0}
    for row in matrix[1:]:
        longer: dict[tuple[int, ...], Value] = {}
        entries = {k: x for k, x in enumerate(row) if x != 0}
        for columns, minor in minors.items():
            for column in entries.keys() - set(columns):
                key = tuple(sorted((*columns, column)))
                # The sign of the last row's entry in the expansion of the larger minor.
                term = entries[column] * minor
                odd = (len(key) - 1 - key.index(column)) % 2
                if key not in longer:
                    longer[key] = term * -1 if odd else term
                else:
                    longer[key] = longer[key] - term if odd else longer[key] + term
        if len(longer) > _MOST_MINORS:
            problem = f"coordinates are too many: det J has more than {_MOST_MINORS} minors"
            raise LimitError("volume", size, problem)
        minors = {key: x for key, x in longer.items() if x != 0}
    return minors.get(tuple(range(size)), matrix[0][0] - matrix[0][0])
