"""The certificate of a proof for one H: its identities, with the cofactors that show them."""

import sympy

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.coordinates import PLANE
from verify.proof.certificates.file import Certificate
from verify.proof.certificates.statement import (
    Form,
    Plain,
    Statement,
    certificate_of_one,
    entries_of,
    in_the_plane,
)
from verify.proof.expansion import ClosedSeries, series_of
from verify.proof.plane.potential import Potential
from verify.proof.proof import Proof
from verify.proof.telescoping import potential_of_lie
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

_NOTHING = "there is nothing to certify"


def of_one(proof: Proof, potential: Potential | None = None) -> Certificate:
    """The certificate of a proof for one H; `potential`: of ΔJ's leading coefficient in the plane.

    Raises InputError where nothing is proved, where the map is no polynomial in h that is written
    out, and where H needs other functions than sin, cos, exp and denominators.
    """
    agreed = proof.convergence_order
    if proof.verdict is not Verdict.PROVED or agreed is None:
        raise InputError("proof", proof.verdict.value, _NOTHING)
    if proof.planar:
        return _in_plane(proof, potential or Potential(None, ""), agreed)
    if agreed < 0:
        raise InputError("proof", proof.verdict.value, _NOTHING)
    return _in_degrees(proof, agreed)


def _in_plane(proof: Proof, potential: Potential, agreed: int) -> Certificate:
    step_map = proof.step_map
    hamiltonian = step_map.hamiltonian
    if agreed < 0:
        raise InputError("map", str(step_map.p_next), "is not (p, q) at h = 0: no certificate")
    if step_map.flat.degree is None or (proof.order is None) != (proof.area_preserving is True):
        raise InputError("map", str(step_map.p_next), "is no polynomial in h: no certificate")
    asked = [
        hamiltonian.exact,
        *step_map.composed,
        proof.leading,
        potential.potential or sympy.S.Zero,
    ]
    field, elements = canonical_field(hamiltonian, *asked)
    plain = Plain(field.ring, PLANE)
    energy, p_next, q_next, leading, potential_ = elements
    needed = max(proof.order or 0, agreed) if proof.order else None
    has_potential = proof.order is not None and potential.potential is not None
    without = plain.without_constants(potential_, plain.variables)
    statement = Statement(
        PLANE,
        [_coefficients(plain.ring, x)[: needed and needed + 1] for x in (p_next, q_next)],
        proof.order,
        agreed,
        in_the_plane(leading),
        in_the_plane(without) if has_potential else None,
    )
    return certificate_of_one(statement, plain, energy, proof.witness)


def _coefficients(ring: Ring, x: Poly) -> list[Poly]:
    """Those of h⁰, h¹, … of a polynomial in h."""
    powers = ring.powers(x, "h")
    return [powers.get(n, ring.zero) for n in range(max(powers, default=0) + 1)]


def _in_degrees(proof: Proof, agreed: int) -> Certificate:
    step = proof.step_map
    most = max(proof.order or 0, agreed)
    if proof.order is None:
        degree = step.closed.degree if step.formulas is not None and step.closed else None
        if degree is None:
            shown = step.hamiltonian.formula
            raise InputError("map", shown, "is not written out as a polynomial in h")
        most = degree
    leading = None if proof.order is None else proof.first.form
    field, rows, entries = _in_one_field(step, most, entries_of(leading))
    plain = Plain(field.ring, field.names)
    eta = step.flow_up_to
    has_potential = proof.telescopes and eta > 0 and eta % 2 == 0  # of odd η S ≡ 0 does, without
    potential = potential_of_lie(field, eta) if has_potential else None
    statement = Statement(
        field.names,
        rows,
        proof.order,
        agreed,
        entries,
        None if potential is None else entries_of(potential),
    )
    return certificate_of_one(statement, plain, field.energy, proof.witness)


def _in_one_field(
    step: StepMap, most: int, entries: Form
) -> tuple[CanonicalField, list[list[Poly]], Form]:
    """The coefficients of h⁰ … h^most in each coordinate, and a form's entries, in one ring."""
    series = series_of(step, most)
    if not isinstance(series, ClosedSeries):
        columns = [series.coefficient(n) for n in range(most + 1)]
        return series.flow, [list(row) for row in zip(*columns, strict=True)], entries
    # Where h stands in a function each coefficient has a ring of its own.
    parts = [series.coefficient(k, n) for k in range(2 * step.degrees) for n in range(most + 1)]
    ring, _ = parts[0]
    exact = [ring.expression(x) for ring, x in parts]
    exact += [ring.expression(x) for x in entries.values()]
    field, elements = canonical_field(step.hamiltonian, *exact)
    size = len(parts)
    rows = [elements[at : at + most + 1] for at in range(0, size, most + 1)]
    return field, rows, dict(zip(entries, elements[size:], strict=True))
