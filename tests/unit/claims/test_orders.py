"""Claims about orders and area of one H: true, off by one, undecided."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.sampled.identities.drawn import HIDDEN
from verify.claims.base_claim import Findings
from verify.claims.kinds.area_preserving import AreaClaim
from verify.claims.kinds.convergence_order import ConvergenceOrderClaim
from verify.claims.kinds.defect_order import DefectOrderClaim
from verify.claims.kinds.order import AMBIGUOUS, OrderClaim
from verify.claims.orders import ProvedOrder, judge_vanishing
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.verdict import Verdict

PROVED, REFUTED, UNDECIDED = Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED
DUFFING = "p**2/2 + q**2/2 + delta*q**4/4"
PENDULUM = "p**2/2 - cos(q)"
HARMONIC = "p**2/2 + q**2/2"
HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
# H and scheme -> the orders of ΔJ or S (None where it is 0) and of convergence, by hand.
KNOWN = {
    (DUFFING, "lie1"): (2, 1),
    (DUFFING, "lie2"): (3, 2),
    (DUFFING, "lie3"): (4, 3),
    (DUFFING, "symplectic-euler"): (None, 1),
    (PENDULUM, "lie1"): (2, 1),
    (PENDULUM, "lie2"): (3, 2),
    (PENDULUM, "symplectic-euler"): (None, 1),
    (HARMONIC, "lie1"): (2, 1),
    (HARMONIC, "lie2"): (4, 2),  # det J = 1 + h⁴/4
    (HARMONIC, "lie3"): (4, 3),
    (HARMONIC, "lie4"): (6, 4),
    (DUFFING, "p_next = p - h*(q + delta*q**3); q_next = q + h*p"): (2, 1),
    (HENON, "lie2"): (3, 2),
    (HENON, "stormer-verlet"): (None, 2),
    (PENDULUM, "p_next = p; q_next = q"): (None, 0),
    (PENDULUM, "p_next = p - h*sin(q) + h**9*p; q_next = q + h*p_next"): (9, 1),
}
every_case = pytest.mark.parametrize(("at", "orders"), KNOWN.items(), ids=lambda x: str(x)[:40])


def judged(claim: Any, hamiltonian: str, **scene: Any) -> ClaimResult:
    made = Scene(hamiltonian=hamiltonian, schemes=(claim.scheme,), name="made", **scene)
    return claim.judge(Findings({"made": made}))


def order(r: int, scheme: str, **more: Any) -> DefectOrderClaim:
    return DefectOrderClaim(id="c", scene="made", scheme=scheme, kind="defect_order",
                            defect_order=r, **more)  # fmt: skip


def convergence(k: int, scheme: str, **more: Any) -> ConvergenceOrderClaim:
    return ConvergenceOrderClaim(id="c", scene="made", scheme=scheme, kind="convergence_order",
                                 convergence_order=k, **more)  # fmt: skip


def area(holds: bool, scheme: str, **more: Any) -> AreaClaim:
    return AreaClaim(id="c", scene="made", scheme=scheme, kind="area_preserving",
                     area_preserving=holds, **more)  # fmt: skip


@every_case
def test_the_order_of_delta_j_is_proved_and_every_other_refuted(at: Any, orders: Any) -> None:
    hamiltonian, scheme = at
    for r in range(1, 12):
        exactly = judged(order(r, scheme), hamiltonian).verdict
        assert exactly is (PROVED if r == orders[0] else REFUTED), r
        at_least = judged(order(r, scheme, at_least=True), hamiltonian).verdict
        assert at_least is (PROVED if orders[0] is None or r <= orders[0] else REFUTED), r


@every_case
def test_the_order_of_convergence_is_proved_and_every_other_refuted(at: Any, orders: Any) -> None:
    hamiltonian, scheme = at
    for k in range(1, 7):
        assert judged(convergence(k, scheme), hamiltonian).verdict is (
            PROVED if k == orders[1] else REFUTED
        )
        assert judged(convergence(k, scheme, at_least=True), hamiltonian).verdict is (
            PROVED if k <= orders[1] else REFUTED
        )


@every_case
def test_area_preservation_is_proved_or_refuted(at: Any, orders: Any) -> None:
    hamiltonian, scheme = at
    preserved = orders[0] is None
    assert judged(area(preserved, scheme), hamiltonian).verdict is PROVED
    assert judged(area(not preserved, scheme), hamiltonian).verdict is REFUTED


def test_a_value_of_a_parameter_counts() -> None:
    zero = {"parameters": {"delta": Fraction(0)}}
    assert judged(order(3, "lie2"), DUFFING).verdict is PROVED
    assert judged(order(3, "lie2"), DUFFING, **zero).verdict is REFUTED
    assert judged(order(4, "lie2"), DUFFING, **zero).verdict is PROVED


# log(q²) − 2 log(q) is 0 where q > 0, and the ring does not know it.
def test_what_is_not_decided_in_the_ring_leaves_orders_undecided_from_there_on() -> None:
    scheme = f"p_next = p - h*sin(q) + h**5*p*({HIDDEN}); q_next = q + h*p_next"
    found = {r: judged(order(r, scheme), PENDULUM).verdict for r in range(1, 8)}
    assert [found[r] for r in range(1, 5)] == [REFUTED] * 4
    assert {found[r] for r in range(5, 8)} == {UNDECIDED}
    at_least = {r: judged(order(r, scheme, at_least=True), PENDULUM).verdict for r in (4, 5, 6)}
    assert at_least == {4: PROVED, 5: PROVED, 6: UNDECIDED}
    assert judged(area(True, scheme), PENDULUM).verdict is UNDECIDED
    assert judged(area(False, scheme), PENDULUM).verdict is UNDECIDED


def test_a_map_that_may_be_exact_to_higher_order_leaves_convergence_undecided() -> None:
    scheme = f"p_next = p + h*({HIDDEN}); q_next = q + h*p"
    found = judged(convergence(1, scheme), "p**2/2").verdict
    assert found is UNDECIDED


@pytest.mark.parametrize("r", [1, 12])
def test_the_exact_flow_has_every_order_looked_at(r: int) -> None:
    free = "p_next = p; q_next = q + h*p"
    assert judged(convergence(r, free, at_least=True), "p**2/2").verdict is PROVED
    exactly = judged(convergence(r, free), "p**2/2").verdict
    assert exactly is (REFUTED if r < 12 else UNDECIDED)


@pytest.mark.parametrize(
    ("known", "exactly", "at_least"),
    [
        (ProvedOrder(3, True, False, "e"), {2: REFUTED, 3: PROVED, 4: REFUTED},
         {3: PROVED, 4: REFUTED}),
        (ProvedOrder(3, False, None, "e"), {2: REFUTED, 3: UNDECIDED, 4: UNDECIDED},
         {3: PROVED, 4: UNDECIDED}),
        (ProvedOrder(3, False, False, "e"), {2: REFUTED, 3: UNDECIDED}, {3: PROVED, 4: UNDECIDED}),
        (ProvedOrder(0, False, True, "e"), {1: REFUTED}, {1: PROVED, 40: PROVED}),
    ],
)  # fmt: skip
def test_orders_are_judged_by_what_is_known(
    known: ProvedOrder, exactly: Any, at_least: Any
) -> None:
    for r, verdict in exactly.items():
        assert order(r, "lie2").judge_proved(known).verdict is verdict
    for r, verdict in at_least.items():
        assert order(r, "lie2", at_least=True).judge_proved(known).verdict is verdict


def test_area_is_judged_by_what_is_known() -> None:
    for vanishes, true, false in (
        (True, PROVED, REFUTED),
        (False, REFUTED, PROVED),
        (None, UNDECIDED, UNDECIDED),
    ):
        known = ProvedOrder(0, False, vanishes, "e")
        for claimed, verdict in ((True, true), (False, false)):
            found = judge_vanishing(area(claimed, "lie2"), known, claimed)
            assert found.verdict is verdict


# -- the paper's schemes, off by one --------------------------------------------------------------


@pytest.mark.parametrize("hamiltonian", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
@pytest.mark.parametrize("scheme", ["lie2", "symplectic-euler"])
def test_every_planted_order_of_the_papers_schemes_is_refuted(
    hamiltonian: str, scheme: str
) -> None:
    delta_j, agreement = KNOWN[hamiltonian, scheme]
    true: list[Any] = [convergence(agreement, scheme), area(delta_j is None, scheme)]
    planted: list[Any] = [convergence(agreement + 1, scheme), area(delta_j is not None, scheme)]
    planted += [convergence(agreement - 1, scheme)] if agreement > 1 else []
    if delta_j is not None:
        true.append(order(delta_j, scheme))
        planted += [order(delta_j + d, scheme) for d in (1, -1)]
    assert {judged(claim, hamiltonian).verdict for claim in true} == {PROVED}
    assert {judged(claim, hamiltonian).verdict for claim in planted} == {REFUTED}


@pytest.mark.parametrize("every", [None, "hamiltonian"])
def test_a_bare_order_is_judged_as_a_defect_order_and_says_what_to_write(every: Any) -> None:
    for r in (2, 3):  # the method's order, which is refuted; and that of ΔJ
        old = OrderClaim(id="c", scene="made", scheme="lie2", kind="order", order=r, every=every)
        new = judged(order(r, "lie2", every=every), DUFFING)
        found = judged(old, DUFFING)
        assert (found.verdict, found.domain) == (new.verdict, new.domain)
        assert found.evidence == f"{new.evidence}; {AMBIGUOUS}"
        assert AMBIGUOUS not in new.evidence
    assert "defect_order" in AMBIGUOUS
    assert "convergence_order" in AMBIGUOUS
