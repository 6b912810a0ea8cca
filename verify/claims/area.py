"""Claims about orders in h and det J ≡ 1, of one H or of every H, decided by exact algebra."""

from dataclasses import dataclass
from typing import Any

from verify.algebra.formula import to_text
from verify.claims.findings import Checks, Findings, result
from verify.claims.formulas import step_map_of
from verify.claims.kinds import AreaClaim, ConvergenceOrderClaim, OrderClaim
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import convergence_of, leading_of
from verify.scenes.results.claim import ClaimResult
from verify.schemes.step_map import StepMap
from verify.verdict import Verdict


@dataclass(frozen=True)
class ProvedOrder:
    """What is proved of an order: it is at least `least`, and no more than that where `exact`.

    `vanishes`: whether it is that of the zero function, which has every order; None where that is
    not decided. `evidence` says so in one line.
    """

    least: int
    exact: bool
    vanishes: bool | None
    evidence: str


def check_order(claim: OrderClaim, findings: Findings) -> ClaimResult:
    return judge_order(claim, claim.order, delta_j_order(_map(claim, findings)))


def check_convergence_order(claim: ConvergenceOrderClaim, findings: Findings) -> ClaimResult:
    known = convergence_order(_map(claim, findings))
    return judge_order(claim, claim.convergence_order, known)


def check_area(claim: AreaClaim, findings: Findings) -> ClaimResult:
    known = delta_j_order(_map(claim, findings))
    return judge_area(claim, known.vanishes, known.evidence)


def _map(claim: Any, findings: Findings) -> StepMap:
    return step_map_of(findings.scene_of(claim).exact_hamiltonian(), claim.scheme)


# -- what is proved of one H ----------------------------------------------------------------------


def delta_j_order(step_map: StepMap) -> ProvedOrder:
    """The order of ΔJ in h."""
    leading = leading_of(step_map)
    beyond, decision = MOST_ORDERS + 1, leading.decision
    if decision.zero is True:
        return ProvedOrder(beyond, False, True, "ΔJ is the zero function: det J ≡ 1")
    power = beyond if leading.power is None else leading.power
    if decision.zero is None or leading.power is None:
        evidence = f"ΔJ = O(h^{power}), and whether of higher order is not decided"
        evidence += "; ΔJ is not the zero function" if decision.zero is False else ""
        return ProvedOrder(power, False, decision.zero, evidence)
    at = ", ".join(f"{name} = {value}" for name, value in decision.witness.items())
    where = f"; at {at} the coefficient is {decision.enclosure}" if at else ""
    term = f"({to_text(leading.coefficient)})·h^{power}"
    return ProvedOrder(power, True, False, f"ΔJ = {term} + O(h^{power + 1}){where}")


def convergence_order(step_map: StepMap) -> ProvedOrder:
    """To which power of h the map agrees with the exact flow."""
    found = convergence_of(step_map)
    if found.order is None:
        evidence = f"the map agrees with the exact flow in all orders looked at, {MOST_ORDERS}"
        return ProvedOrder(MOST_ORDERS, False, None, evidence)
    agrees = f"the map agrees with the exact flow up to h^{found.order}"
    if found.order < 0:
        agrees = "the map does not agree with the exact flow even at h = 0"
    more = " and no further" if found.decided else "; whether further is not decided"
    return ProvedOrder(found.order, found.decided, False, agrees + more)


# -- verdicts -------------------------------------------------------------------------------------


def judge_order(
    claim: OrderClaim | ConvergenceOrderClaim, order: int, known: ProvedOrder
) -> ClaimResult:
    """Whether the order is the claimed one, or with `at_least` no lower one."""
    verdict = Verdict.UNDECIDED
    if claim.at_least:
        if order <= known.least or known.vanishes:
            verdict = Verdict.PROVED
        elif known.exact:
            verdict = Verdict.REFUTED
    elif known.vanishes or order < known.least or (known.exact and order != known.least):
        verdict = Verdict.REFUTED
    elif known.exact:
        verdict = Verdict.PROVED
    return result(claim, verdict, known.evidence)


def judge_area(claim: AreaClaim, vanishes: bool | None, evidence: str) -> ClaimResult:
    """Whether ΔJ ≡ 0 is as claimed."""
    if vanishes is None:
        return result(claim, Verdict.UNDECIDED, evidence)
    holds = vanishes == claim.area_preserving
    return result(claim, Verdict.PROVED if holds else Verdict.REFUTED, evidence)


CHECKS: Checks = {
    OrderClaim: check_order,
    ConvergenceOrderClaim: check_convergence_order,
    AreaClaim: check_area,
}
