"""A closed 2-form ω, constant or depending on z: its defect is S = Jᵀω(z')J − ω(z).

The canonical form Ω = Σ dp_i∧dq_i is the structure of a canonical step: in the plane it is area.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.lazy_sympy import sympy
from verify.structures.structure import StepValues, Structure, Value, accumulated_defect, is_zero

# The coefficients of dz_a∧dz_b, a < b. In quotes, for here sympy would be imported.
Entries = Mapping[tuple[int, int], "sympy.Expr"]


@dataclass(frozen=True)
class SymplecticForm(Structure):
    """A 2-form Σ ω_ab dz_a∧dz_b; `entries`: its coefficients, by a < b."""

    entries: Entries = field(default_factory=dict, hash=False)

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return "S = Jᵀω(z')J − ω(z)"

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return tuple(self.entries.values())

    def with_values(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Structure:
        """Return the structure with these values in place of parameters."""
        entries = {place: x.xreplace(values) for place, x in self.entries.items()}
        return type(self)(self.name, self.label, entries)

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        return form_defect(step, self.entries)

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observable of a run that is its accumulated defect."""
        return (accumulated_defect(f"form = {form_text(self.entries, names)}"),)

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        if len(names) % 2:
            return f"is degenerate: {len(names)} coordinates are an odd number"
        matrix = sympy.zeros(len(names), len(names))
        for (a, b), x in self.entries.items():
            matrix[a, b], matrix[b, a] = x, -x
        if is_zero(matrix.det(method="berkowitz"), names) is not False:
            return "is degenerate: the determinant of its matrix vanishes, or is not shown not to"
        for a, b, c in combinations(range(len(names)), 3):
            cycle = ((a, b, c), (b, c, a), (c, a, b))
            parts = (matrix[i, j].diff(symbol(names[k])) for i, j, k in cycle)
            if is_zero(sum(parts, sympy.S.Zero), names) is not True:
                return f"is not closed: dω has d{names[a]}∧d{names[b]}∧d{names[c]}"
        return ""


def form_defect(
    step: StepValues, entries: Entries, factor: Value | None = None
) -> dict[str, Value]:
    """Return the entries a < b of Jᵀω(z')J − c ω(z), by dz_a∧dz_b; `factor`: c, which may be 1."""
    after = {place: step.after(x) for place, x in entries.items()}
    before = {place: step.before(x) for place, x in entries.items()}
    jacobian, result = step.jacobian, {}
    for a, b in combinations(range(len(step.names)), 2):
        total = step.number(Fraction(0))
        for (c, d), x in after.items():
            minor = jacobian[c][a] * jacobian[d][b] - jacobian[d][a] * jacobian[c][b]
            total = total + x * minor
        if (a, b) in before:
            share = before[a, b]
            total = total - (share if factor is None else factor * share)
        result[f"d{step.names[a]}∧d{step.names[b]}"] = total
    return result


def form_text(entries: Entries, names: Sequence[str]) -> str:
    """Return a 2-form as a text that `verify.structures.reading` reads back."""
    coefficients = {place: "" if x == 1 else f"({to_text(x)})*" for place, x in entries.items()}
    return " + ".join(f"{x}d{names[a]}^d{names[b]}" for (a, b), x in coefficients.items())


def canonical_entries(size: int) -> Entries:
    """Return the coefficients of Ω = Σ dp_i∧dq_i on p1 … pn, q1 … qn, 2n = `size`."""
    half = size // 2
    return {(i, half + i): sympy.S.One for i in range(half)}


@dataclass(frozen=True)
class CanonicalForm(Structure):
    """The canonical form Ω, which in the plane is area.

    `state`: the name of a point; `symbol`: that of the defect of one step; `accumulated`: the
    defect of N steps, and `size` its size.

    `zero`: the kind of object that the defect is where it vanishes; `vanishes` is the sentence that
    it does, `identity` the short form, and `claim` that of a scheme that claims it. `of_step`,
    `of_run`, `over_run`: the observables of a run for the greatest defect of a step, the
    accumulated defect, and its greatest value during the run.
    """

    # Both structures have the same fields, so that no caller has to ask for the plane.

    state: str
    symbol: str
    accumulated: str
    size: str
    zero: str
    vanishes: str
    identity: str
    claim: str
    of_step: str
    of_run: str
    over_run: str

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return self.symbol

    @property
    def formulas(self) -> tuple[sympy.Expr, ...]:
        """The formulas of which the structure is made."""
        return (sympy.S.One,)

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        return form_defect(step, canonical_entries(len(step.names)))

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observables of a run: its accumulated defect, at the end and the greatest."""
        return self.of_run, self.over_run

    def mistake(self, names: Sequence[str]) -> str:
        """Return what keeps it from being a structure; "" if nothing does."""
        return f"is of pairs p, q, and there are {len(names)} coordinates" if len(names) % 2 else ""


SYMPLECTIC = CanonicalForm(
    name="symplectic",
    label="the symplectic form",
    state="z",
    symbol="S",
    accumulated="W",
    size="max |W|",
    zero="form",
    vanishes="S is the zero form: the map is symplectic",
    identity="S ≡ 0",
    claim="to be symplectic",
    of_step="symplectic_defect_max",
    of_run="symplectic_defect",
    over_run="symplectic_defect",
)
