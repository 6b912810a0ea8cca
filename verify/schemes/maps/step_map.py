"""The exact one-step map z → z' of one Hamiltonian, and its Jacobian J = ∂z'/∂z (Eq. 12).

z = (p1 … pn, q1 … qn); n = 1 is the plane, z = (p, q). The step is written once, in the operations
of `verify.schemes.steps.step_algebra`, and read as a series in h, as a closed form, in balls, or as
a kernel's program; a user's map is given in closed form. Its defect is S = JᵀΩJ − Ω, which in the
plane is ΔJ dp∧dq, ΔJ = det J − 1 (Eq. 14).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.algebra.ring import Poly, Ring
from verify.effort import MAX_CALLS, limit_effort
from verify.errors import InputError, LimitError
from verify.hamiltonians.canonical_field import CanonicalField, PlainField, field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.notebook import aligned_latex, short_latex
from verify.schemes.conditions.condition import Condition
from verify.schemes.maps.ball_algebra import may_be_uniform, may_conserve, may_preserve
from verify.schemes.maps.closed_form import (
    ClosedForm,
    factored_by_powers,
    group_by_powers,
    unfactored_text,
)
from verify.schemes.maps.closed_form_algebras import (
    TooLongError,
    elements_of,
    expressions_of,
    is_polynomial,
    terms_in,
)
from verify.schemes.steps.step_algebra import State, Step, series_of
from verify.structures import CanonicalForm

# Limits of a composition in closed form: terms in its parts, terms written out, terms of S, and
# occurrences of coordinates.
_MOST_IN_PARTS, _MOST_COMPOSED, _MOST_OF_DEFECT, _MOST_WRITTEN = 150, 150, 5000, 5000
_MOST_FACTORED_TERMS = 1000  # a ΔJ of more terms is printed without factoring
AT_STAGES = "H is smooth at the stages"
_NOT_WRITTEN = "the implicit scheme's map is given by equations, and has no closed form"


def solvable(structure: CanonicalForm) -> str:
    """Return the assumption under which an implicit scheme has a smooth map, as text."""
    return f"the stages have a solution that depends smoothly on {structure.state}"


@dataclass(frozen=True, eq=False)
class StepMap:
    """A one-step map of one Hamiltonian; it is equal only to itself, as comparing maps is slow.

    `step`: the step in a step algebra; or `formulas`: z' in the field's ring. `conditions`: if all
    hold, the map is symplectic, for every H that the scheme takes. `known_order()`: the order of
    the map for this H if that is known without its series, else None. `formula_domain`: the domain
    of the scheme's own formulas. `implicit`: True if the step solves equations. `keeps_quadratic`:
    True if the conditions also imply that quadratic first integrals are kept. `expand(most)`: z' up
    to h^most with the field in its ring, for a map that is known only by its series.
    """

    hamiltonian: Hamiltonian
    field: PlainField
    step: Step | None = None
    formulas: tuple[Poly, ...] | None = None
    conditions: tuple[Condition, ...] = ()
    known_order: Callable[[], int | None] = lambda: None
    formula_domain: FormulaDomain = EVERYWHERE
    implicit: bool = False
    keeps_quadratic: bool = False
    expand: Callable[[int], tuple[PlainField, State]] | None = None

    def __repr__(self) -> str:
        return f"StepMap of {self.hamiltonian!r}"

    def _repr_latex_(self) -> str:
        """Return z' in closed form, if that is short enough."""
        names = self.hamiltonian.coordinates
        lines = [rf"{name}' &= \text{{(not written in closed form)}}" for name in names]
        if self.closed is not None:
            ring = self.closed.ring
            sides = (sympy.latex(group_by_powers(ring, x)) for x in self.closed.elements)
            lines = [f"{name}' &= {short_latex(x)}" for name, x in zip(names, sides, strict=True)]
        return aligned_latex(lines)

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom."""
        return self.field.degrees

    @property
    def structure(self) -> CanonicalForm:
        """The structure that the exact flow keeps: area in the plane, else the symplectic form."""
        return self.hamiltonian.structure

    @property
    def ring(self) -> Ring:
        """The ring of all its elements."""
        return self.field.ring

    @property
    def in_stages(self) -> bool:
        """True if the step evaluates H at other points than z."""
        return self.formulas is None or self.expand is not None

    @cached_property
    def domain(self) -> FormulaDomain:
        """The domain where the map is smooth: H must be smooth at z and at the stages."""
        words = [solvable(self.structure)] if self.implicit else []
        if self.in_stages and self.hamiltonian.domain_moves:
            words.append(AT_STAGES)
        return (
            FormulaDomain.from_requirements((), *words)
            & self.hamiltonian.domain
            & self.formula_domain
        )

    @property
    def flow_up_to(self) -> int:
        """The power of h up to which the formulas are the exact flow's terms; −1 if not seen."""
        return self._written_form.flow_up_to if self._written_form and self.expand is None else -1

    def series(self, most: int) -> tuple[PlainField, State] | None:
        """Return z' up to h^most, with the field in the ring of the coefficients.

        None for a map that has only formulas, which are no polynomials in h.
        """
        if self.expand is not None:
            return self.expand(most)
        if self.step is not None:
            return self.field, series_of(self.field, self.step, most)
        state = self._written_form.series(most) if self._written_form else None
        return None if state is None else (self.field, state)

    # -- its closed form --------------------------------------------------------------------------

    @cached_property
    def _written_form(self) -> ClosedForm | None:
        return None if self.formulas is None else ClosedForm(self.field, self.formulas)

    @cached_property
    def closed(self) -> ClosedForm | None:
        """The map z' written out; None if it is defined by equations or too long."""
        if self._written_form is not None or self.step is None or self.implicit:
            return self._written_form
        if self.terms > _MOST_IN_PARTS:
            return None
        try:
            if is_polynomial(self.field):
                field, elements = self.field, elements_of(self.field, self.step, _MOST_COMPOSED)
            else:
                exact = expressions_of(self.field, self.step, _MOST_WRITTEN)
                field, items = field_of(self.hamiltonian, *exact, most_terms=_MOST_COMPOSED)
                elements = tuple(items)
        except (TooLongError, InputError):
            return None
        closed_form = ClosedForm(field, elements)
        return closed_form if closed_form.products <= _MOST_OF_DEFECT else None

    @property
    def flat(self) -> ClosedForm:
        """The map z' written out; LimitError if it is defined by equations or too long."""
        if self.closed is None:
            formula = str(self.hamiltonian.expression)
            large = "its closed form, all substeps composed, is too large"
            raise LimitError("map", formula, _NOT_WRITTEN if self.implicit else large)
        return self.closed

    @cached_property
    def terms(self) -> int:
        """The number of terms of the formulas, or of the step's slopes and sums."""
        if self._written_form is not None or self.step is None:
            return self._written_form.length if self._written_form else 0
        return terms_in(self.field, self.step)

    @cached_property
    def composed(self) -> tuple[sympy.Expr, ...]:
        """The map z' as expressions, not simplified; LimitError if there are none or it is slow."""
        if self._written_form is not None:
            return tuple(self.ring.expression(x) for x in self._written_form.elements)
        formula = str(self.hamiltonian.expression)
        if self.implicit or self.step is None:
            raise LimitError("map", formula, _NOT_WRITTEN)
        with limit_effort("map", formula, "to compose its parts", MAX_CALLS // 4):
            return tuple(expressions_of(self.field, self.step))

    @property
    def p_next(self) -> sympy.Expr:
        """The expression of p' in closed form, in the plane; see `composed`."""
        return self.composed[0]

    @property
    def q_next(self) -> sympy.Expr:
        """The expression of q' in closed form, in the plane; see `composed`."""
        return self.composed[1]

    @property
    def jacobian(self) -> sympy.Matrix:
        """The Jacobian J = ∂z'/∂z (Eq. 12), 2n × 2n."""
        step = self.flat
        size = len(step.elements)
        entries = [group_by_powers(step.ring, entry) for row in step.jacobian for entry in row]
        return sympy.Matrix(size, size, entries)

    # -- S, and det J − 1 -------------------------------------------------------------------------

    @property
    def conditions_hold(self) -> bool:
        """True if all conditions on its coefficients hold, and there are any."""
        return bool(self.conditions) and all(c.holds is True for c in self.conditions)

    @property
    def is_canonical(self) -> bool:
        """True if it is a step of a Hamiltonian."""
        return isinstance(self.field, CanonicalField)

    @property
    def symplectic_by_conditions(self) -> bool:
        """True if it is symplectic by the conditions on its coefficients."""
        return self.is_canonical and self.conditions_hold

    @property
    def written_defect(self) -> ClosedForm | None:
        """The closed form of a map that is defined by formulas; None if S is too long."""
        written = self._written_form if self.is_canonical else None
        return written if written is not None and written.forms is not None else None

    @cached_property
    def preserves_area(self) -> bool:
        """True if S, in the plane ΔJ, is shown to vanish."""
        if self.symplectic_by_conditions:
            return True
        if not self.is_canonical:
            return self._preserves_volume
        if self._written_form is None and self.step is not None:
            # Balls refute most schemes at the first point; only the others need a closed form.
            if self.implicit or not may_preserve(self.field, self.step):
                return False
            return self.closed is not None and self.closed.symplectic
        return self._written_form is not None and self._written_form.symplectic

    @property
    def _preserves_volume(self) -> bool:
        """True if det J ≡ 1 is shown, for a step of equations without an H."""
        step = self.step or self._written_form
        if self.implicit or step is None or not may_be_uniform(self.field, step):
            return False
        return self.closed is not None and self.closed.preserves_volume() is True

    @cached_property
    def uniform_delta_j(self) -> Poly | None:
        """ΔJ in the plane, if it is shown to depend only on h and H's parameters; else None."""
        step = self.step or self._written_form
        if self.degrees > 1 or step is None or self.implicit:
            return None
        if not may_be_uniform(self.field, step) or self.closed is None:
            return None
        ring, delta_j = self.closed.ring, self.closed.delta_j
        return None if any(ring.depends(delta_j, n) for n in (*self.field.names, "t")) else delta_j

    @cached_property
    def conserves_energy(self) -> bool:
        """True if it is shown that no step changes H."""
        field, step = self.field, self.step or self._written_form
        if not isinstance(field, CanonicalField):
            return False
        if self.keeps_quadratic and self.symplectic_by_conditions and field.quadratic:
            return True
        if field.timed or self.implicit or step is None or not may_conserve(field, step):
            return False
        if self.closed is None:
            return False
        # H(z') − H(z) is expanded in a ring, where equality with 0 is decided.
        before, ring = self.hamiltonian.exact, self.closed.ring
        sides = zip(self.hamiltonian.coordinates, self.closed.elements, strict=True)
        after = before.xreplace({symbol(name): ring.expression(x) for name, x in sides})
        try:
            whole, (change,) = field_of(self.hamiltonian, after - before)
        except InputError:
            return False
        return whole.ring.vanishes(change) is True

    @property
    def has_closed_form(self) -> bool:
        """True if ΔJ has a closed form that is short enough to be written out."""
        return self.preserves_area or self.closed is not None

    @cached_property
    def delta_j(self) -> sympy.Expr:
        """ΔJ = det J − 1 (Eq. 14) in closed form; LimitError if that is too long."""
        if self.preserves_area:
            return sympy.S.Zero
        step = self.flat
        if step.degree is None or self.degrees > 1:
            return step.ring.as_product(step.delta_j)
        return factored_by_powers(step.ring, self._coefficients)

    @property
    def _coefficients(self) -> dict[int, Poly]:
        return {m: form.entry(0, 1) for m, form in (self.flat.forms or {}).items()}

    @cached_property
    def delta_j_text(self) -> str | None:
        """The formula of ΔJ as text; None if the map has no closed form."""
        if not self.has_closed_form:
            return None
        # In n degrees of freedom entry (0, 1) of S is not ΔJ.
        if not self.preserves_area and self.flat.degree is not None and self.degrees == 1:
            coefficients = self._coefficients
            if sum(map(len, coefficients.values())) > _MOST_FACTORED_TERMS:
                return unfactored_text(self.flat.ring, coefficients)
        return to_text(self.delta_j)
