"""The exact one-step map (p, q, h) → (p', q'), its Jacobian J (Eq. 12) and ΔJ = det J − 1 (Eq. 14).

A map is a composition of substeps, each with its own exact closed form: one for the Lie-derivative
scheme, two shears for symplectic Euler; or one in stages (see `verify.schemes.stages`), for a
Runge–Kutta scheme; see `verify.schemes.substep`. 1 + ΔJ of the composition is the product along it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import read, symbol
from verify.algebra.requirement import of_expression
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Series
from verify.effort import MOST, limited
from verify.errors import InputError, LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.vector_field import VectorField
from verify.late import sympy
from verify.notebook import aligned_latex, short_latex
from verify.schemes.composition import composed_polynomials, occurrences, polynomial
from verify.schemes.conditions import Condition
from verify.schemes.stages import chained
from verify.schemes.substep import Substep as Substep
from verify.schemes.substep import h_inside as h_inside

Expanded = tuple[VectorField, Series, Series]  # H's field, and p' and q' in its ring
# Terms of the largest composition that is written in closed form: those in its parts, its own, and
# those of its ΔJ.
_MOST_IN_PARTS = 150
_MOST_FACTORED = 1000  # terms of ΔJ in all, beyond which it is written as it stands
# Of an implicit scheme, for one H and for every one.
SOLVABLE = "the stages have a solution that depends smoothly on (p, q)"
AT_STAGES = "H is smooth at the stages"
_NOT_WRITTEN = "the implicit scheme's map is given by equations, and has no closed form"
_UNWRITTEN = "not written in closed form"
_MOST_COMPOSED, _MOST_OF_DELTA_J = 150, 5000
_MOST_WRITTEN = 5000  # times that p and q occur in it, of which its terms are made


@dataclass(frozen=True, eq=False)
class StepMap:
    """A one-step map of one Hamiltonian, as the composition of its substeps, first one first.

    It equals itself alone, since to compare maps takes long.

    `expansion(most)` is `taylor` of a map whose substeps have stages, which it does not look into.
    `known_order()`: up to which power of h it agrees with the exact flow and no further, where that
    is known without the series; else None. `asked`: what its own operations ask for to be defined,
    beside H.
    """

    hamiltonian: Hamiltonian
    substeps: tuple[Substep, ...]
    expansion: Callable[[int], Expanded] | None = field(default=None, repr=False)
    known_order: Callable[[], int | None] = field(default=lambda: None, repr=False)
    asked: Domain = field(default=EVERYWHERE, repr=False)

    def __repr__(self) -> str:
        return f"StepMap of {self.hamiltonian!r}, in {len(self.substeps)} parts"

    def _repr_latex_(self) -> str:
        """p' and q' in closed form, where that is short enough."""
        lines = [rf"{name}' &= \text{{({_UNWRITTEN})}}" for name in ("p", "q")]
        if self.closed is not None:
            step = self.closed
            sides = (sympy.latex(grouped(step.ring, x)) for x in (step.p_next, step.q_next))
            lines = [f"{name}' &= {short_latex(x)}" for name, x in zip("pq", sides, strict=True)]
        return aligned_latex(lines)

    @cached_property
    def domain(self) -> Domain:
        """Where the map is smooth: where H is, and is so at the stages, if there are any."""
        words = [SOLVABLE] if self.implicit else []
        if (self.of_parts or self.implicit) and self.hamiltonian.domain_moves:
            words.append(AT_STAGES)
        return Domain.of((), *words) & self.hamiltonian.domain & self.asked

    @cached_property
    def implicit(self) -> bool:
        """Whether it is given by equations, and has no closed form."""
        return any(step.implicit for step in self.substeps)

    @property
    def conditions(self) -> tuple[Condition, ...]:
        """What is known exactly of coefficients, and shows ΔJ ≡ 0 where all of it holds."""
        return tuple(c for step in self.substeps for c in step.conditions)

    @property
    def of_parts(self) -> bool:
        """Whether its closed form has to be composed, and may be large."""
        return self.expansion is not None or len(self.substeps) > 1

    def taylor(self, most: int) -> Expanded | None:
        """The Taylor series of p' and q' up to h^most, and the vector field in their ring.

        None where the closed form is to be looked at instead.
        """
        if self.expansion is not None:
            return self.expansion(most)
        whole = self.substeps[0].field
        ring = whole.ring
        if any(step.field is not whole for step in self.substeps):
            return None
        p, q = (Series.of(ring, [ring.variable(name)], most) for name in ("p", "q"))
        for step in self.substeps:
            moved = step.taylor(p, q)
            if moved is None:
                return None
            p, q = moved
        return whole, p, q

    @classmethod
    def from_expressions(
        cls, hamiltonian: Hamiltonian, p_next: sympy.Expr, q_next: sympy.Expr
    ) -> StepMap:
        """A map from p' and q' as expressions in p, q, h; InputError where they are not smooth."""
        whole, (p1, q1) = hamiltonian.field(p_next, q_next)
        asked = Domain.of(r for x in (p_next, q_next) for r in of_expression(x, smooth=True))
        return cls(hamiltonian, (Substep(whole, p1, q1),), asked=asked)

    @classmethod
    def from_formulas(cls, hamiltonian: Hamiltonian, p_next: str, q_next: str) -> StepMap:
        """A user's own map, from formulas in p, q, h, the parameters of H, and t where H has it.

        `q_next` may also use p_next, and then stands for the composition. Raises InputError.
        """
        time = ("t",) if hamiltonian.time_dependent else ()
        names = ("p", "q", "h", *time, *hamiltonian.parameters)
        if "p_next" in names:
            raise InputError("parameter", "p_next", "stands for p' in a map's formulas")
        p1, asked = read(p_next, names, source="p_next")
        q1, more = read(q_next, (*names, "p_next"), source="q_next")
        put = {symbol("p_next"): p1}
        written = Domain.of([*asked, *more]).replaced(put)
        with limited("q_next", q_next, "to put p_next into it"):
            pair = [hamiltonian.put_in(x) for x in (p1, q1.xreplace(put))]
        made = cls.from_expressions(hamiltonian, *pair)
        return replace(made, asked=made.asked & written.replaced(hamiltonian.put))

    @cached_property
    def composed(self) -> tuple[sympy.Expr, sympy.Expr]:
        """p' and q' in closed form. Raises InputError for a map that is given by equations."""
        if self.implicit:
            raise LimitError("map", str(self.hamiltonian.expression), _NOT_WRITTEN)
        p, q = p1, q1 = symbol("p"), symbol("q")
        with limited("map", str(self.hamiltonian.expression), "to compose its parts", MOST // 4):
            for step in self.substeps:
                put = {p: p1, q: q1}
                p1, q1 = (step.ring.expression(x).xreplace(put) for x in (step.p_next, step.q_next))
        return p1, q1

    @property
    def p_next(self) -> sympy.Expr:
        """p' in closed form; see `composed`."""
        return self.composed[0]

    @property
    def q_next(self) -> sympy.Expr:
        """q' in closed form; see `composed`."""
        return self.composed[1]

    @cached_property
    def closed(self) -> Substep | None:
        """The whole map as one substep in closed form; None where a composition is too large."""
        if self.implicit:
            return None
        if not self.of_parts:
            return self.substeps[0]
        if sum(step.length for step in self.substeps) > _MOST_IN_PARTS:
            return None
        parts = [(step.p_next, step.q_next) for step in self.substeps]
        whole = self.substeps[0].field
        if polynomial(whole.ring, parts) and all(step.field is whole for step in self.substeps):
            found = composed_polynomials(whole.ring, parts, _MOST_COMPOSED)
        elif occurrences(whole.ring, parts) > _MOST_WRITTEN:
            return None
        else:
            try:
                whole, found = self.hamiltonian.field(*self.composed, most_terms=_MOST_COMPOSED)
            except InputError:
                return None
        step = Substep(whole, found[0], found[1]) if found else None
        return step if step and step.terms_of_delta_j <= _MOST_OF_DELTA_J else None

    @cached_property
    def whole(self) -> Substep:
        """The whole map as one substep: in closed form, or where that is too large in stages."""
        if self.closed is not None:
            return self.closed
        if len(self.substeps) == 1:
            return self.substeps[0]
        first = self.substeps[0].field
        return Substep(*chained(first, [(step.p_next, step.q_next) for step in self.substeps]))

    @property
    def flat(self) -> Substep:
        """The whole map as one substep in closed form; InputError where that is too large."""
        if self.closed is None:
            shown = str(self.hamiltonian.expression)
            large = "its closed form, all substeps composed, is too large"
            raise LimitError("map", shown, _NOT_WRITTEN if self.implicit else large)
        return self.closed

    @property
    def has_closed_form(self) -> bool:
        """Whether ΔJ has a closed form that is short enough to be written out."""
        return self.preserves_area or self.closed is not None

    @cached_property
    def preserves_area(self) -> bool:
        """True where every substep's ΔJ, and so the composition's, is shown to vanish."""
        return all(step.preserves_area for step in self.substeps)

    @property
    def jacobian(self) -> sympy.Matrix:
        """J = ∂(p', q')/∂(p, q) (Eq. 12), 2 × 2."""
        step = self.flat
        return sympy.Matrix(2, 2, [grouped(step.ring, entry) for entry in step.jacobian])

    @cached_property
    def delta_j(self) -> sympy.Expr:
        """ΔJ = det J − 1 (Eq. 14) in closed form; InputError where that is too large."""
        if self.preserves_area:
            return sympy.S.Zero
        step = self.flat
        if step.degree is None:
            return step.ring.factored(step.delta_j)
        return _by_powers(step.ring, self._coefficients)

    @cached_property
    def _coefficients(self) -> dict[int, Poly]:
        return {n: self.flat.coefficient(n) for n in range((self.flat.degree or 0) + 1)}

    @cached_property
    def delta_j_text(self) -> str | None:
        """ΔJ as a formula; None where its closed form is too large."""
        if not self.has_closed_form:
            return None
        if not self.preserves_area and self.flat.degree is not None:
            coefficients = self._coefficients
            if sum(map(len, coefficients.values())) > _MOST_FACTORED:
                return _long_text(self.flat.ring, coefficients)
        return to_text(self.delta_j)


def _long_text(ring: Ring, coefficients: Mapping[int, Poly]) -> str:
    """Σ hⁿ cₙ as it stands, for coefficients that are too long to be factored."""
    parts = (f"h**{n}*({ring.text(c)})" for n, c in sorted(coefficients.items()) if not c.is_zero())
    return " + ".join(parts)


def grouped(ring: Ring, x: Poly) -> sympy.Expr:
    """x as an expression: by powers of h, each coefficient factored, where h stands outside."""
    if h_inside(ring, x):
        return ring.factored(x)
    return _by_powers(ring, ring.powers(x, "h"))


def _by_powers(ring: Ring, coefficients: Mapping[int, Poly]) -> sympy.Expr:
    """Σ hⁿ cₙ, each coefficient factored."""
    h = symbol("h")
    return sympy.Add(*(h**n * ring.factored(c) for n, c in sorted(coefficients.items())))
