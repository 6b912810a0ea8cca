"""What is established follows from what is checked; its oracle has digits enough."""

from dataclasses import asdict

from tests.helpers.sampled.certificates import as_read, of_text
from tests.oracle.printed_certificates import is_true
from verify.proof.certificates.certification import certify_for_every_h
from verify.proof.certificates.checker import check
from verify.proof.certificates.established_statement import state_theorem
from verify.proof.order_for_every_h import prove_for_every_h


def test_what_is_established_is_derived_from_what_is_checked() -> None:
    said = state_theorem(check(as_read(certify_for_every_h(prove_for_every_h("lie2")))))
    assert (said.order, said.convergence_order, said.hamiltonian) == (3, 2, "every smooth H")
    assert said.scheme == "the Taylor series of the flow, cut off after h^2, up to O(h^4)"
    assert said.potential == "H_pp*H_qq/2 - H_pq**2/2"
    assert said.statement == (
        "det J − 1 = L h^3 + O(h^4), L not zero for some H, for every smooth H and this map, "
        "which agrees with the flow up to h^2, and L = X·G"
    )
    said = state_theorem(check(of_text("p**2/2 + d/(1 + q**2)", "symplectic-euler")))
    assert (said.order, said.leading, said.area_preserving) == (None, None, True)
    assert said.hamiltonian == "d/(q**2 + 1) + p**2/2"
    assert said.p_next == "p + h*(2*d*q/(q**2 + 1)**2)"
    assert (said.scheme, said.domain) == (None, ("q**2 + 1 != 0",))
    said = state_theorem(
        check(as_read(certify_for_every_h(prove_for_every_h("implicit-midpoint"))))
    )
    assert said.p_next == "p1 = p - h*(1)*H_q(p + (1/2)*(p1 - p), q + (1/2)*(q1 - q))"
    assert said.domain == ("the stages have a solution that depends smoothly on (p, q)",)


def test_the_oracle_has_digits_enough_for_coefficients_of_any_length() -> None:
    """A shear by 10¹²⁰·H_q preserves area; 100 digits cannot tell after two powers of it."""
    data = as_read(certify_for_every_h(prove_for_every_h("stormer-verlet", separable=True)))
    data["stages"][0][0] = str(10**120)
    said = asdict(state_theorem(check(data)))
    assert is_true(said, points=1)
    wrong = said | {"q_next": said["q_next"].replace("q1 = q", "q1 = q + h*p*q", 1)}
    assert not is_true(wrong, points=1)
