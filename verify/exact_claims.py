"""Claims that exact algebra decides: printed step maps, Jacobians, ΔJ, and sums made of ΔJ.

Printed formulas keep the parameters as symbols, so that a claim is checked for all their values.
The difference between the printed and the computed expression is decided to be zero or not in the
ring; where it is not, the evidence is the difference and a point at which it is enclosed away
from zero.
"""

from collections.abc import Sequence
from typing import Any

import sympy

from verify.claims import DeltaJClaim, Findings, JacobianClaim, StepMapClaim, result
from verify.formula import parse, symbol, to_text
from verify.hamiltonian import Hamiltonian
from verify.proof.order import Expansion
from verify.results import ClaimResult
from verify.ring import Decision, Poly, Ring
from verify.schemes import get
from verify.step_map import H_STEP, StepMap, grouped, h_inside
from verify.verdict import Verdict

Gap = tuple[str, Ring, Poly, Decision]  # what, and printed − computed with the decision on it


def _step_map(claim: Any, findings: Findings) -> StepMap:
    """The scheme's exact map with all parameters as symbols."""
    hamiltonian = findings.scene(claim.scene).exact_hamiltonian()
    return get(claim.scheme).step_map(Hamiltonian(hamiltonian.expression))


def _parse(claim: Any, step_map: StepMap, text: str, more: Sequence[str] = ()) -> sympy.Expr:
    names = ("p", "q", "h", *step_map.hamiltonian.parameters, *more)
    return parse(text, names, source=f"claim {claim.id}")


def _gaps(step_map: StepMap, pairs: Sequence[tuple[str, sympy.Expr, sympy.Expr]]) -> list[Gap]:
    """printed − computed for each (what, printed, computed), decided in one ring."""
    differences = [printed - computed for _, printed, computed in pairs]
    field, elements = step_map.hamiltonian.field(*differences)
    ring = field.ring
    return [
        (what, ring, x, ring.decide(x)) for (what, _, _), x in zip(pairs, elements, strict=True)
    ]


def check_step_map(claim: StepMapClaim, findings: Findings) -> ClaimResult:
    step_map = _step_map(claim, findings)
    p_next = _parse(claim, step_map, claim.p_next)
    q_next = _parse(claim, step_map, claim.q_next, ["p_next"]).subs(symbol("p_next"), p_next)
    pairs = [("p′", p_next, step_map.p_next), ("q′", q_next, step_map.q_next)]
    order = findings.proof(findings.scene(claim.scene), claim.scheme).convergence_order
    agreement = "every order looked at" if order is None else f"h^{order}"
    holds = (
        f"p′ and q′ are those of {claim.scheme}, term by term, and agree with the exact flow up to "
        f"{agreement}"
    )
    return _from_gaps(claim, _gaps(step_map, pairs), holds)


def check_jacobian(claim: JacobianClaim, findings: Findings) -> ClaimResult:
    step_map = _step_map(claim, findings)
    computed = step_map.jacobian
    names = (("∂p′/∂p", "∂p′/∂q"), ("∂q′/∂p", "∂q′/∂q"))
    pairs = [
        (names[i][j], _parse(claim, step_map, claim.entries[i][j]), computed[i, j])
        for i in (0, 1)
        for j in (0, 1)
    ]
    return _from_gaps(
        claim, _gaps(step_map, pairs), "all four entries are those of the exact Jacobian"
    )


_PRINTED_AS = {
    "delta_j": "ΔJ",
    "mse_summand": "the bracket that is squared in the mean (ΔJ by Eq. 15)",
    "lambda_factor": "the factor of the product (det J by Eq. 16)",
}


def check_delta_j(claim: DeltaJClaim, findings: Findings) -> ClaimResult:
    step_map = _step_map(claim, findings)
    printed = _parse(claim, step_map, claim.formula)
    if claim.kind == "lambda_factor":
        printed -= 1
    what = _PRINTED_AS[claim.kind]
    gap = _gaps(step_map, [(what, printed, step_map.delta_j)])[0]
    if claim.up_to is None:
        holds = f"{what}, as printed, agrees with det J − 1 exactly, for all p, q, h and parameters"
        return _from_gaps(claim, [gap], holds)
    return _up_to(claim, gap)


def _up_to(claim: DeltaJClaim, gap: Gap) -> ClaimResult:
    """Whether the difference is O(h^up_to)."""
    what, ring, x, _ = gap
    expansion = Expansion(ring, x)
    assert claim.up_to is not None  # noqa: S101 - the caller's condition
    for n in range(claim.up_to):
        own, coefficient = expansion.coefficient(n)
        decision = own.decide(coefficient)
        if decision.zero is not True:
            term = H_STEP**n * own.factored(coefficient)
            return _refuted_or_not(claim, what, to_text(term), decision)
    return result(
        claim,
        Verdict.PROVED,
        f"{what} as printed differs from det J − 1 by O(h^{claim.up_to}): the "
        f"difference is {to_text(-grouped(ring, x))}",
    )


def _from_gaps(claim: Any, gaps: Sequence[Gap], holds: str) -> ClaimResult:
    """PROVED where all differences vanish, else what the first one that does not is."""
    wrong = [g for g in gaps if g[3].zero is not True]
    wrong.sort(key=lambda g: g[3].zero is None)  # a refutation before a doubt
    if not wrong:
        return result(claim, Verdict.PROVED, holds)
    what, ring, x, decision = wrong[0]
    shown = ring.factored(x) if h_inside(ring, x) else grouped(ring, x)
    return _refuted_or_not(claim, what, to_text(shown), decision)


def _refuted_or_not(claim: Any, what: str, difference: str, decision: Decision) -> ClaimResult:
    if decision.zero is None:
        return result(
            claim,
            Verdict.UNDECIDED,
            f"{what}: printed − computed = {difference}, neither shown to vanish nor not to",
        )
    at = ", ".join(f"{name} = {value}" for name, value in decision.witness.items())
    point = f"; at {at} it is {decision.enclosure}" if at else ""
    return result(
        claim, Verdict.REFUTED, f"{what}: printed − computed = {difference}, not zero{point}"
    )


CHECKS = {
    StepMapClaim: check_step_map,
    JacobianClaim: check_jacobian,
    DeltaJClaim: check_delta_j,
}
