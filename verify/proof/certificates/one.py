"""The certificate of a proof for one H: its identities, with the cofactors that show them."""

import sympy

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.coordinates import PLANE
from verify.proof.certificates.file import Certificate
from verify.proof.certificates.statement import (
    Form,
    Statement,
    certificate_of_one,
    entries_of,
    layout_of,
    without_constants,
)
from verify.proof.expansion import ClosedSeries, series_of
from verify.proof.plane.potential import Potential
from verify.proof.proof import Proof
from verify.proof.telescoping import potential_of_lie
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict


def certify_one(proof: Proof, potential: Potential | None = None) -> Certificate:
    """Write the certificate of a proof for one H.

    `potential`: of ΔJ's leading coefficient in the plane. Raises InputError where nothing is
    proved, where the map has no closed form that is a polynomial in h, and where H needs other
    functions than sin, cos, exp and denominators.
    """
    if proof.verdict is not Verdict.PROVED or proof.convergence_order is None:
        raise InputError("proof", proof.verdict.value, "there is nothing to certify")
    make = {AREA: _in_plane, SYMPLECTIC: _in_degrees}[proof.structure]
    field, statement = make(proof, potential or Potential(None, ""))
    return certificate_of_one(statement, field, proof.witness)


def _in_plane(proof: Proof, potential: Potential) -> tuple[CanonicalField, Statement]:
    step, order, agreed = proof.step_map, proof.order, proof.convergence_order or 0
    if step.flat.degree is None or (order is None) != (proof.area_preserving is True):
        raise InputError("map", str(step.p_next), "is no polynomial in h: no certificate")
    others = *step.composed, proof.leading, potential.potential or sympy.S.Zero
    field, (*after, leading, telescoping) = canonical_field(step.hamiltonian, *others)
    last = max(order, agreed) + 1 if order else None
    has_potential = order is not None and potential.potential is not None
    # X·c = 0 for a constant c, so G is written without constants.
    without = without_constants(field.ring, telescoping, (*PLANE, "t"))
    return field, Statement(
        layout_of(field.names),
        [_coefficients(field.ring, x)[:last] for x in after],
        order,
        agreed,
        _form(leading),
        _form(without) if has_potential else None,
    )


def _coefficients(ring: Ring, x: Poly) -> list[Poly]:
    """Return the coefficients of h⁰, h¹, … of a polynomial in h."""
    powers = ring.powers(x, "h")
    return [powers.get(n, ring.zero) for n in range(max(powers, default=0) + 1)]


def _form(x: Poly) -> Form:
    """Return x dp∧dq as a form."""
    return {} if x.is_zero() else {PLANE: x}


def _in_degrees(proof: Proof, _: Potential) -> tuple[CanonicalField, Statement]:
    step, order, agreed = proof.step_map, proof.order, proof.convergence_order or 0
    most: int | None = max(order or 0, agreed)
    if order is None:
        most = step.closed.degree if step.formulas is not None and step.closed else None
    if most is None:
        formula = step.hamiltonian.formula
        raise InputError("map", formula, "is not written out as a polynomial in h")
    form = None if order is None else proof.first.form
    series, entries = series_of(step, most), entries_of(form)
    if isinstance(series, ClosedSeries):
        # Where h stands in a function each coefficient has a ring of its own, and so has S.
        others = [form.ring.expression(x) for x in entries.values()] if form else []
        field, rows, elements = series.in_one_field(step.hamiltonian, most, *others)
        entries = dict(zip(entries, elements, strict=True))
    else:
        field, columns = series.flow, [series.coefficient(n) for n in range(most + 1)]
        rows = [list(row) for row in zip(*columns, strict=True)]
    eta = step.flow_up_to
    has_potential = proof.telescopes and eta > 0 and eta % 2 == 0  # of odd η S ≡ 0 does, without
    potential = entries_of(potential_of_lie(field, eta)) if has_potential else None
    return field, Statement(layout_of(field.names), rows, order, agreed, entries, potential)
