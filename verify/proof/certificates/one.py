"""The certificate of a proof for one H: its identities, with the cofactors that show them."""

import sympy

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.coordinates import PLANE
from verify.proof.certificates.file import Certificate
from verify.proof.certificates.plain import Plain
from verify.proof.certificates.statement import Statement, certificate_of_one, in_the_plane
from verify.proof.order_proof import Proof
from verify.proof.potential import Potential
from verify.verdict import Verdict


def of_one(proof: Proof, potential: Potential) -> Certificate:
    """The certificate of a proof for one H.

    Raises InputError where nothing is proved, where the map is not a polynomial in h, and where H
    needs other functions than sin, cos, exp and denominators.
    """
    step_map = proof.step_map
    hamiltonian = step_map.hamiltonian
    if proof.verdict is not Verdict.PROVED or proof.convergence_order is None:
        raise InputError("proof", proof.verdict.value, "there is nothing to certify")
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
