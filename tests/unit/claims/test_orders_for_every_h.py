"""Claims about orders and area of every H, held against a stub of the proof."""

import sys
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import pytest

from tests.unit.claims.test_orders import PROVED, REFUTED, UNDECIDED, area, convergence, order
from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.claims.base_claim import Findings
from verify.claims.kinds.delta_j import DeltaJClaim
from verify.errors import InputError
from verify.verdict import Verdict


@dataclass(frozen=True)
class Stub:
    """The fields of `verify.proof.proof_for_every_h.ProofForEveryH` that a claim asks for."""

    verdict: Verdict = PROVED
    reason: str = "by hand"
    order: int | None = 3
    area_preserving: bool | None = False
    convergence_order: int | None = 2
    leading: str = "H_p*H_ppq - 2*H_q*H_ppp"
    domain: FormulaDomain = EVERYWHERE
    convergence_decided: bool = True
    nearby: None = None


EULER = Stub(order=None, area_preserving=True, convergence_order=1, leading="0")
OPEN = Stub(UNDECIDED, "left open", None, None, None, "0")


@pytest.fixture
def proofs(monkeypatch: pytest.MonkeyPatch) -> dict[tuple[str, bool], Stub]:
    """What is proved, by scheme and whether H is separable."""
    known = {("lie2", False): Stub(), ("lie2", True): Stub(),
             ("symplectic-euler", True): EULER, ("lie3", False): OPEN}  # fmt: skip
    module = ModuleType("verify.proof.order_for_every_h")
    module.prove_for_every_h = lambda name, separable=False, **_: known[name, separable]  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "verify.proof.order_for_every_h", module)
    return known


EVERY, SEPARABLE = {"every": "hamiltonian"}, {"every": "separable hamiltonian"}


@pytest.mark.usefixtures("proofs")
@pytest.mark.parametrize(
    ("claim", "expected"),
    [
        (order(3, "lie2", **EVERY), PROVED),
        (order(2, "lie2", **EVERY), REFUTED),
        (order(4, "lie2", **EVERY), REFUTED),
        (order(2, "lie2", at_least=True, **EVERY), PROVED),
        (order(4, "lie2", at_least=True, **EVERY), REFUTED),
        (order(3, "lie3", **EVERY), UNDECIDED),
        (order(1, "symplectic-euler", **SEPARABLE), REFUTED),
        (order(9, "symplectic-euler", at_least=True, **SEPARABLE), PROVED),
        (convergence(2, "lie2", **EVERY), PROVED),
        (convergence(1, "lie2", **EVERY), REFUTED),
        (convergence(3, "lie2", **EVERY), REFUTED),
        (convergence(3, "lie3", **EVERY), UNDECIDED),
        (area(False, "lie2", **EVERY), PROVED),
        (area(True, "lie2", **EVERY), REFUTED),
        (area(True, "symplectic-euler", **SEPARABLE), PROVED),
        (area(False, "symplectic-euler", **SEPARABLE), REFUTED),
        (area(True, "lie3", **EVERY), UNDECIDED),
    ],
)
def test_a_claim_of_every_h_is_held_against_the_proof(claim: Any, expected: Verdict) -> None:
    found = claim.judge(Findings({}))
    assert found.verdict is expected
    assert found.evidence


def test_a_map_that_reached_all_that_was_looked_at_may_be_of_higher_order(proofs: Any) -> None:
    proofs["lie2", False] = Stub(convergence_order=3, convergence_decided=False)
    found = {k: convergence(k, "lie2", **EVERY).judge(Findings({})).verdict
             for k in (2, 3, 4)}  # fmt: skip
    assert found == {2: REFUTED, 3: UNDECIDED, 4: UNDECIDED}


def first_term(formula: str, up_to: int = 4, scheme: str = "lie2", **every: str) -> DeltaJClaim:
    return DeltaJClaim(id="c", scheme=scheme, kind="delta_j", formula=formula, up_to=up_to,
                       **(every or EVERY))  # type: ignore[arg-type]  # fmt: skip


@pytest.mark.usefixtures("proofs")
@pytest.mark.parametrize(
    ("formula", "up_to", "expected"),
    [
        ("h**3*(H_p*H_ppq - 2*H_q*H_ppp)", 4, PROVED),
        ("h**3*(H_p*H_qpp - 2*H_01*H_30) + 7*h**4*H_q", 4, PROVED),
        ("0", 3, PROVED),
        ("h**3*(H_p*H_ppq + 2*H_q*H_ppp)", 4, REFUTED),
        ("h**3*(H_p*H_ppq - 2*H_q*H_pppp)", 4, REFUTED),
        ("h**2*(H_p*H_ppq - 2*H_q*H_ppp)", 4, REFUTED),
        ("2*h**3*(H_p*H_ppq - 2*H_q*H_ppp)", 4, REFUTED),
        ("0", 4, REFUTED),
        ("h**3*(H_p*H_ppq - 2*H_q*H_ppp)", 5, UNDECIDED),
        ("h**3*(H_p*H_ppq - 3*H_q*H_ppp)", 5, REFUTED),
    ],
)
def test_the_first_term_for_every_h_is_held_against_the_proof(
    formula: str, up_to: int, expected: Verdict
) -> None:
    assert first_term(formula, up_to).judge(Findings({})).verdict is expected


@pytest.mark.usefixtures("proofs")
def test_mixed_derivatives_of_a_separable_h_vanish() -> None:
    formula = "-2*h**3*H_q*H_ppp"
    assert first_term(formula).judge(Findings({})).verdict is REFUTED
    assert first_term(formula, **SEPARABLE).judge(Findings({})).verdict is PROVED
    euler = first_term("h**4*H_pq", 8, "symplectic-euler", **SEPARABLE)
    assert euler.judge(Findings({})).verdict is PROVED
    wrong = first_term("h**4*H_pp", 8, "symplectic-euler", **SEPARABLE)
    assert wrong.judge(Findings({})).verdict is REFUTED


@pytest.mark.usefixtures("proofs")
@pytest.mark.parametrize("formula", ["h**3*T_p", "h*H_x", "h*delta", "h*H_pq5", "h**", "h*H"])
def test_other_names_than_derivatives_of_h_are_input_errors(formula: str) -> None:
    with pytest.raises(InputError, match="claim c: formula"):
        first_term(formula).judge(Findings({}))
