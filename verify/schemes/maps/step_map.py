"""The exact one-step map z → z' of one Hamiltonian, and its Jacobian J = ∂z'/∂z (Eq. 12).

z = (p1 … pn, q1 … qn); n = 1 is the plane, z = (p, q). The step is written once, in the operations
of `verify.schemes.steps.step_algebra`, and read as a series in h, as a closed form, in balls, or as
a kernel's program; a user's map is given in closed form. What it misses is S = JᵀΩJ − Ω, which in
the plane is ΔJ dp∧dq, ΔJ = det J − 1 (Eq. 14).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.algebra.ring import Poly, Ring
from verify.effort import MOST, limited
from verify.errors import InputError, LimitError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.late import sympy
from verify.notebook import aligned_latex, short_latex
from verify.schemes.conditions.condition import Condition
from verify.schemes.maps.ball_algebra import may_be_uniform, may_conserve, may_preserve
from verify.schemes.maps.closed_form import ClosedForm, h_inside
from verify.schemes.maps.written_out import (
    TooLongError,
    elements_of,
    expressions_of,
    is_polynomial,
    terms_in,
)
from verify.schemes.steps.step_algebra import State, Step, series_of
from verify.structures import Structure

# Of the largest composition that is written in closed form: terms in its parts, its own, those of
# S, and how often coordinates occur in it.
_MOST_IN_PARTS, _MOST_COMPOSED, _MOST_OF_DEFECT, _MOST_WRITTEN = 150, 150, 5000, 5000
_MOST_FACTORED = 1000  # terms of ΔJ in all, beyond which it is written as it stands
AT_STAGES = "H is smooth at the stages"
_NOT_WRITTEN = "the implicit scheme's map is given by equations, and has no closed form"
_UNWRITTEN = "not written in closed form"


def solvable(structure: Structure) -> str:
    """What is taken for granted of an implicit scheme, for one H and for every one."""
    return f"the stages have a solution that depends smoothly on {structure.state}"


@dataclass(frozen=True, eq=False)
class StepMap:
    """A one-step map of one Hamiltonian. It equals itself alone, since to compare maps takes long.

    `step`: how z' is made; or `formulas`: z' in the field's ring, of a map that is given so.
    `conditions`: where all of them hold the map is symplectic, for every H that the scheme takes.
    `known_order()`: up to which power of h it agrees with the exact flow and no further, where that
    is known without the series; else None. `asked`: where the scheme's own formulas are defined.
    `implicit`: equations are solved for it. `keeps_quadratic`: where the conditions hold it keeps
    every quadratic invariant of the motion too. `expand`: z' up to h^most over a ring that comes
    with it, of a map whose steps are not looked into.
    """

    hamiltonian: Hamiltonian
    field: CanonicalField
    step: Step | None = None
    formulas: tuple[Poly, ...] | None = None
    conditions: tuple[Condition, ...] = ()
    known_order: Callable[[], int | None] = lambda: None
    asked: Domain = EVERYWHERE
    implicit: bool = False
    keeps_quadratic: bool = False
    expand: Callable[[int], tuple[CanonicalField, State]] | None = None

    def __repr__(self) -> str:
        return f"StepMap of {self.hamiltonian!r}"

    def _repr_latex_(self) -> str:
        """z' in closed form, where that is short enough."""
        names = self.hamiltonian.coordinates
        lines = [rf"{name}' &= \text{{({_UNWRITTEN})}}" for name in names]
        if self.closed is not None:
            ring = self.closed.ring
            sides = (sympy.latex(grouped(ring, x)) for x in self.closed.elements)
            lines = [f"{name}' &= {short_latex(x)}" for name, x in zip(names, sides, strict=True)]
        return aligned_latex(lines)

    @property
    def degrees(self) -> int:
        """Of freedom."""
        return self.field.degrees

    @property
    def structure(self) -> Structure:
        """What a canonical step of it keeps."""
        return self.hamiltonian.structure

    @property
    def ring(self) -> Ring:
        """The ring of all its elements."""
        return self.field.ring

    @property
    def in_stages(self) -> bool:
        """Whether it is made of H at other points than z, and its closed form may be large."""
        return self.formulas is None or self.expand is not None

    @cached_property
    def domain(self) -> Domain:
        """Where the map is smooth: where H is, and is so at the stages, if there are any."""
        words = [solvable(self.structure)] if self.implicit else []
        if self.in_stages and self.hamiltonian.domain_moves:
            words.append(AT_STAGES)
        return Domain.of((), *words) & self.hamiltonian.domain & self.asked

    @property
    def flow_up_to(self) -> int:
        """The power of h up to which it is made of the exact flow's own terms; −1 where that is not
        seen."""
        return self._given.flow_up_to if self._given and self.expand is None else -1

    def series(self, most: int) -> tuple[CanonicalField, State] | None:
        """z' up to h^most, with the field in the ring of the coefficients.

        None of a map that has none but its closed form's, which is no polynomial in h.
        """
        if self.expand is not None:
            return self.expand(most)
        if self.step is not None:
            return self.field, series_of(self.field, self.step, most)
        state = self._given.series(most) if self._given else None
        return None if state is None else (self.field, state)

    # -- its closed form --------------------------------------------------------------------------

    @cached_property
    def _given(self) -> ClosedForm | None:
        if self.formulas is None:
            return None
        return ClosedForm(self.field, self.formulas)

    @cached_property
    def closed(self) -> ClosedForm | None:
        """z' written out; None where it is given by equations, or too long."""
        if self._given is not None or self.step is None or self.implicit:
            return self._given
        if self.terms > _MOST_IN_PARTS:
            return None
        try:
            if is_polynomial(self.field):
                elements = elements_of(self.field, self.step, _MOST_COMPOSED)
                return self._short(ClosedForm(self.field, elements))
            exact = expressions_of(self.field, self.step, _MOST_WRITTEN)
            whole, embedded = canonical_field(self.hamiltonian, *exact, most_terms=_MOST_COMPOSED)
        except (TooLongError, InputError):
            return None
        return self._short(ClosedForm(whole, tuple(embedded)))

    def _short(self, closed: ClosedForm) -> ClosedForm | None:
        return closed if closed.products <= _MOST_OF_DEFECT else None

    @property
    def flat(self) -> ClosedForm:
        """z' written out; LimitError where it is given by equations, or too long."""
        if self.closed is None:
            shown = str(self.hamiltonian.expression)
            large = "its closed form, all substeps composed, is too large"
            raise LimitError("map", shown, _NOT_WRITTEN if self.implicit else large)
        return self.closed

    @cached_property
    def terms(self) -> int:
        """How many there are in what it is made of."""
        if self._given is not None or self.step is None:
            return self._given.length if self._given else 0
        return terms_in(self.field, self.step)

    @cached_property
    def composed(self) -> tuple[sympy.Expr, ...]:
        """z' as expressions, as they come. Raises LimitError for a map that is given by equations,
        or takes too long."""
        if self._given is not None:
            return tuple(self.ring.expression(x) for x in self._given.elements)
        shown = str(self.hamiltonian.expression)
        if self.implicit or self.step is None:
            raise LimitError("map", shown, _NOT_WRITTEN)
        with limited("map", shown, "to compose its parts", MOST // 4):
            return tuple(expressions_of(self.field, self.step))

    @property
    def p_next(self) -> sympy.Expr:
        """p' in closed form, in the plane; see `composed`."""
        return self.composed[0]

    @property
    def q_next(self) -> sympy.Expr:
        """q' in closed form, in the plane; see `composed`."""
        return self.composed[1]

    @property
    def jacobian(self) -> sympy.Matrix:
        """J = ∂z'/∂z (Eq. 12), 2n × 2n."""
        step = self.flat
        size = len(step.elements)
        entries = [grouped(step.ring, entry) for row in step.jacobian for entry in row]
        return sympy.Matrix(size, size, entries)

    # -- S, and det J − 1 -------------------------------------------------------------------------

    @property
    def symplectic_by_conditions(self) -> bool:
        """Whether it is symplectic by what its coefficients fulfil."""
        return bool(self.conditions) and all(c.holds is True for c in self.conditions)

    @property
    def written_defect(self) -> ClosedForm | None:
        """Of a map that is given in closed form: that, where S is not too long to be written."""
        return self._given if self._given and self._given.forms is not None else None

    @cached_property
    def preserves_area(self) -> bool:
        """True where S, in the plane ΔJ, is shown to vanish."""
        if self.symplectic_by_conditions:
            return True
        if self._given is None and self.step is not None:
            if self.implicit or not may_preserve(self.field, self.step):
                return False
            return self.closed is not None and self.closed.symplectic
        return self._given is not None and self._given.symplectic

    @cached_property
    def uniform_delta_j(self) -> Poly | None:
        """ΔJ of a map in the plane, in the ring of its closed form, where it is shown to depend on
        h and H's parameters alone; else None."""
        step = self.step or self._given
        if self.degrees > 1 or step is None or self.implicit:
            return None
        if not may_be_uniform(self.field, step) or self.closed is None:
            return None
        ring, delta_j = self.closed.ring, self.closed.delta_j
        return None if any(ring.depends(delta_j, n) for n in (*self.field.names, "t")) else delta_j

    @cached_property
    def conserves_energy(self) -> bool:
        """True where H is shown to be the same after every step."""
        field, step = self.field, self.step or self._given
        if self.keeps_quadratic and self.symplectic_by_conditions and field.quadratic:
            return True
        if field.timed or self.implicit or step is None or not may_conserve(field, step):
            return False
        if self.closed is None:
            return False
        before, ring = self.hamiltonian.exact, self.closed.ring
        sides = zip(self.hamiltonian.coordinates, self.closed.elements, strict=True)
        after = before.xreplace({symbol(name): ring.expression(x) for name, x in sides})
        try:
            whole, (change,) = canonical_field(self.hamiltonian, after - before)
        except InputError:
            return False
        return whole.ring.vanishes(change) is True

    @property
    def has_closed_form(self) -> bool:
        """Whether ΔJ has a closed form that is short enough to be written out."""
        return self.preserves_area or self.closed is not None

    @cached_property
    def delta_j(self) -> sympy.Expr:
        """ΔJ = det J − 1 (Eq. 14) in closed form; LimitError where that is too large."""
        if self.preserves_area:
            return sympy.S.Zero
        step = self.flat
        if step.degree is None or self.degrees > 1:
            return step.ring.factored(step.delta_j)
        return _by_powers(step.ring, self._coefficients)

    @property
    def _coefficients(self) -> dict[int, Poly]:
        return {m: form.at(0, 1) for m, form in (self.flat.forms or {}).items()}

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
