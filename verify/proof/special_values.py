"""Proofs at the rational parameter values that a proof excludes."""

from dataclasses import dataclass
from fractions import Fraction
from functools import partial

import sympy

from verify.effort import answer_unless_long
from verify.errors import InputError
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.schemes.scheme import Scheme


@dataclass(frozen=True)
class SpecialValue:
    """A value of a parameter, and the proof for it."""

    parameter: str
    value: Fraction
    proof: Proof


def special_values(proof: Proof, scheme: Scheme) -> list[SpecialValue]:
    """Prove the scheme at the values that the proof excludes for a single parameter.

    Only values that a linear condition excludes are found; H must be defined at them.
    """
    values, hamiltonian = [], proof.step_map.hamiltonian
    for requirement in proof.first.domain.requirements:
        names = requirement.expression.free_symbols
        if len(names) != 1 or not requirement.expression.is_polynomial(*names):
            continue
        polynomial = answer_unless_long(partial(sympy.Poly, requirement.expression, *names), None)
        # Roots of higher degree may be irrational, for which H has no exact parameter value.
        if polynomial is None or polynomial.degree() != 1:
            continue
        slope, constant = polynomial.all_coeffs()
        if not (slope.is_Rational and constant.is_Rational):
            continue
        root = Fraction(int(-constant.p * slope.q), int(constant.q * slope.p))
        (name,) = (s.name for s in names)
        try:
            special = hamiltonian.with_values({**dict(hamiltonian.values), name: root})
            special_proof = prove(scheme.step_map(special), scheme)
        except InputError:  # H is not defined there
            continue
        values.append(SpecialValue(name, root, special_proof))
    return values
