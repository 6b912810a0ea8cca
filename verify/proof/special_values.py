"""What holds at the parameter values that a proof leaves out, where they are rational numbers."""

from dataclasses import dataclass
from fractions import Fraction
from functools import partial

import sympy

from verify.effort import unless_long
from verify.errors import InputError
from verify.proof.order import prove
from verify.proof.proof import Proof
from verify.schemes.scheme import Scheme


@dataclass(frozen=True)
class SpecialValue:
    """The proof where this parameter has this value."""

    parameter: str
    value: Fraction
    proof: Proof


def special_values(proof: Proof, scheme: Scheme) -> list[SpecialValue]:
    """For each single parameter that must not have one value, what is proved at that value."""
    found, hamiltonian = [], proof.step_map.hamiltonian
    for requirement in proof.first.domain.requirements:
        names = requirement.expression.free_symbols
        if len(names) != 1 or not requirement.expression.is_polynomial(*names):
            continue
        polynomial = unless_long(partial(sympy.Poly, requirement.expression, *names), None)
        if polynomial is None or polynomial.degree() != 1:
            continue
        slope, constant = polynomial.all_coeffs()
        if not (slope.is_Rational and constant.is_Rational):
            continue
        root = Fraction(int(-constant.p * slope.q), int(constant.q * slope.p))
        (name,) = (s.name for s in names)
        try:
            special = hamiltonian.with_values({**dict(hamiltonian.values), name: root})
            there = prove(scheme.step_map(special), scheme)
        except InputError:  # H is not defined there
            continue
        found.append(SpecialValue(name, root, there))
    return found
