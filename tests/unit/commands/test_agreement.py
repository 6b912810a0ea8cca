"""How far a map agrees with the exact flow, and whether that is all that is known of it."""

from dataclasses import replace

import pytest

from verify.commands.shared.proof_output import agreement_json, describe_agreement
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.order_for_one_h import prove
from verify.schemes import get

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
HENON = Hamiltonian.parse("p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3")


@pytest.mark.parametrize(("scheme", "order"), [("lie2", 2), ("stormer-verlet", 2), ("lie4", 4)])
def test_an_order_that_is_shown_to_be_no_higher_is_known(scheme: str, order: int) -> None:
    plane = prove(get(scheme).step_map(PENDULUM), get(scheme))
    for found in (
        plane,
        prove(get(scheme).step_map(HENON), get(scheme)),
        prove_for_every_h(scheme, degrees=2),
    ):
        assert describe_agreement(found) == f"up to h^{order}"
        told = {"convergence_order": order, "convergence_order_known": True}
        assert agreement_json(found) == told
        least = replace(found, convergence_decided=False)
        assert describe_agreement(least) == f"up to h^{order}; whether further is not decided"
        assert agreement_json(least) == told | {"convergence_order_known": False}


def test_what_agrees_in_all_that_was_looked_at_has_no_known_order() -> None:
    free = Hamiltonian.parse("p**2/2")
    found = prove(get("lie2").step_map(free), get("lie2"))
    assert describe_agreement(found) == "in all powers of h that were looked at"
    assert agreement_json(found) == {"convergence_order": None, "convergence_order_known": False}
