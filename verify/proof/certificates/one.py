"""The certificate of a proof for one H: its identities, with the cofactors that show them."""

import sympy

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.file import Certificate
from verify.proof.certificates.statement import (
    Plain,
    Statement,
    certificate_of_one,
    entries_of,
    in_the_plane,
)
from verify.proof.expansion import series_of
from verify.proof.order_proof import Proof
from verify.proof.potential import Potential
from verify.proof.symplectic.proof import SymplecticProof
from verify.proof.telescoping import potential_of_lie
from verify.schemes.degrees import map_in_degrees
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

_NOTHING = "there is nothing to certify"


def of_one(proof: Proof, potential: Potential) -> Certificate:
    """The certificate of a proof for one H.

    Raises InputError where nothing is proved, where the map is not a polynomial in h, and where H
    needs other functions than sin, cos, exp and denominators.
    """
    step_map = proof.step_map
    hamiltonian = step_map.hamiltonian
    if proof.verdict is not Verdict.PROVED or proof.convergence_order is None:
        raise InputError("proof", proof.verdict.value, _NOTHING)
    if proof.convergence_order < 0:
        raise InputError("map", str(step_map.p_next), "is not (p, q) at h = 0: no certificate")
    if step_map.flat.degree is None or (proof.order is None) != (proof.area_preserving is True):
        raise InputError("map", str(step_map.p_next), "is no polynomial in h: no certificate")
    asked = [
        hamiltonian.exact,
        *step_map.composed,
        proof.leading,
        potential.potential or sympy.S.Zero,
    ]
    field, elements = hamiltonian.field(*asked)
    plain = Plain(field.ring, PLANE)
    energy, p_next, q_next, leading, potential_ = elements
    needed = max(proof.order or 0, proof.convergence_order) if proof.order else None
    has_potential = proof.order is not None and potential.potential is not None
    without = plain.without_constants(potential_, plain.variables)
    statement = Statement(
        PLANE,
        [_coefficients(plain.ring, x)[: needed and needed + 1] for x in (p_next, q_next)],
        proof.order,
        proof.convergence_order,
        in_the_plane(leading),
        in_the_plane(without) if has_potential else None,
    )
    return certificate_of_one(statement, plain, energy, proof.witness)


def _coefficients(ring: Ring, x: Poly) -> list[Poly]:
    """Those of h⁰, h¹, … of a polynomial in h."""
    powers = ring.powers(x, "h")
    return [powers.get(n, ring.zero) for n in range(max(powers, default=0) + 1)]


# -- in n degrees of freedom ----------------------------------------------------------------------


def of_one_in_degrees(
    proof: SymplecticProof, hamiltonian: Hamiltonian, scheme: Scheme
) -> Certificate:
    """The certificate of a proof for one H.

    Raises InputError where nothing is proved, where the map is no polynomial in h that is written
    out, and where H needs other functions than sin, cos, exp and denominators.
    """
    agreed = proof.convergence_order
    if proof.verdict is not Verdict.PROVED or agreed is None or agreed < 0:
        raise InputError("proof", proof.verdict.value, _NOTHING)
    step = map_in_degrees(scheme, hamiltonian)
    most = max(proof.order or 0, agreed)
    if proof.order is None:
        if step.degree is None:
            raise InputError("map", scheme.name, "is not written out as a polynomial in h")
        most = step.degree
    defect = series_of(step, most)
    field, rows = defect.flow, [defect.coefficient(n) for n in range(most + 1)]
    plain = Plain(field.ring, field.names)
    leading = None if proof.order is None else defect.form(proof.order)
    eta = step.flow_up_to
    has_potential = proof.telescopes and eta > 0 and eta % 2 == 0  # of odd η S ≡ 0 does, without
    potential = potential_of_lie(field, eta) if has_potential else None
    columns = [[row[k] for row in rows] for k in range(len(field.names))]
    statement = Statement(
        field.names,
        columns,
        proof.order,
        agreed,
        entries_of(leading),
        None if potential is None else entries_of(potential),
    )
    return certificate_of_one(statement, plain, field.energy, proof.witness)
