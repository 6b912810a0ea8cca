"""Claims that exact algebra decides: printed step maps, Jacobians, ΔJ, and sums made of ΔJ.

A parameter that a formula of the claim names is a symbol there, so that the claim is checked for
all its values; one that none of them names has the scene's value, where it has one.
The difference between the printed and the computed expression is decided to be zero or not in the
ring; where it is not, the evidence is the difference and a point at which it is enclosed away
from zero.
"""

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import sympy

from verify.algebra.formula import parse, symbol, to_text
from verify.algebra.ring import Decision, Poly, Ring
from verify.claims.findings import Checks, Findings, result
from verify.claims.kinds import DeltaJClaim, JacobianClaim, StepMapClaim
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import Expansion
from verify.proof.order import convergence_of
from verify.scenes.results.claim import ClaimResult
from verify.schemes import get
from verify.schemes.step_map import H_STEP, StepMap, grouped, h_inside
from verify.verdict import Verdict

Gap = tuple[str, Ring, Poly, Decision]  # what, and printed − computed with the decision on it


def formulas(claim: Any) -> dict[str, str]:
    """The claim's formulas by the keys under which they stand."""
    if isinstance(claim, StepMapClaim):
        return {"p_next": claim.p_next, "q_next": claim.q_next}
    if isinstance(claim, JacobianClaim):
        return {f"entries.{i}.{j}": claim.entries[i][j] for i in (0, 1) for j in (0, 1)}
    return {"formula": claim.formula} if isinstance(claim, DeltaJClaim) else {}


def read_formulas(claim: Any, parameters: Sequence[str]) -> dict[str, sympy.Expr]:
    """The claim's formulas as expressions in p, q, h and the parameters; InputError names which."""
    found = {}
    for key, written in formulas(claim).items():
        more = ["p_next"] if key == "q_next" else []
        names = ("p", "q", "h", *parameters, *more)
        found[key] = parse(written, names, source=f"claim {claim.id}: {key}")
    return found


def _read(claim: Any, findings: Findings) -> tuple[StepMap, dict[str, sympy.Expr]]:
    """The scheme's exact map, and the claim's formulas with the same parameters as symbols."""
    given = findings.scene_of(claim).exact_hamiltonian()
    read = read_formulas(claim, given.parameters)
    named = set(re.findall(r"[A-Za-z]\w*", " ".join(formulas(claim).values())))
    values = tuple((name, value) for name, value in given.values if name not in named)
    try:
        step_map = step_map_of(Hamiltonian(given.expression, values), claim.scheme)
    except InputError:  # a scheme may take H for the given values only
        step_map = step_map_of(given, claim.scheme)
    put_in = step_map.hamiltonian.put_in
    return step_map, {key: put_in(expression) for key, expression in read.items()}


@lru_cache(maxsize=64)
def step_map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap:
    """The scheme's exact map; several claims speak of one."""
    return get(scheme).step_map(hamiltonian)


def _gaps(step_map: StepMap, pairs: Sequence[tuple[str, sympy.Expr, sympy.Expr]]) -> list[Gap]:
    """printed − computed for each (what, printed, computed), decided in one ring."""
    differences = [printed - computed for _, printed, computed in pairs]
    field, elements = step_map.hamiltonian.field(*differences)
    ring = field.ring
    return [
        (what, ring, x, ring.decide(x)) for (what, _, _), x in zip(pairs, elements, strict=True)
    ]


def check_step_map(claim: StepMapClaim, findings: Findings) -> ClaimResult:
    step_map, read = _read(claim, findings)
    q_next = read["q_next"].subs(symbol("p_next"), read["p_next"])
    pairs = [("p′", read["p_next"], step_map.p_next), ("q′", q_next, step_map.q_next)]
    gaps = _gaps(step_map, pairs)
    if any(gap[3].zero is not True for gap in gaps):
        return _from_gaps(claim, gaps, "")
    order = convergence_of(step_map).order
    agreement = "every order looked at" if order is None else f"h^{order}"
    holds = (
        f"p′ and q′ are those of {claim.scheme}, term by term, and agree with the exact flow up to "
        f"{agreement}"
    )
    return _from_gaps(claim, gaps, holds)


def check_jacobian(claim: JacobianClaim, findings: Findings) -> ClaimResult:
    step_map, read = _read(claim, findings)
    computed = step_map.jacobian
    names = (("∂p′/∂p", "∂p′/∂q"), ("∂q′/∂p", "∂q′/∂q"))
    pairs = [
        (names[i][j], read[f"entries.{i}.{j}"], computed[i, j]) for i in (0, 1) for j in (0, 1)
    ]
    return _from_gaps(
        claim, _gaps(step_map, pairs), "all four entries are those of the exact Jacobian"
    )


PRINTED_AS = {
    "delta_j": "ΔJ",
    "mse_summand": "the bracket that is squared in the mean (ΔJ by Eq. 15)",
    "lambda_factor": "the factor of the product (det J by Eq. 16)",
}


def check_delta_j(claim: DeltaJClaim, findings: Findings) -> ClaimResult:
    what = PRINTED_AS[claim.kind]
    step_map, read = _read(claim, findings)
    printed = delta_j_printed(claim, read["formula"])
    gap = _gaps(step_map, [(what, printed, step_map.delta_j)])[0]
    if claim.up_to is None:
        holds = f"{what}, as printed, agrees with det J − 1 exactly, for all p, q, h and parameters"
        return _from_gaps(claim, [gap], holds)
    return _up_to(claim, gap)


def delta_j_printed(claim: DeltaJClaim, formula: sympy.Expr) -> sympy.Expr:
    """ΔJ as the claim's formula prints it."""
    return formula - 1 if claim.kind == "lambda_factor" else formula


def _up_to(claim: DeltaJClaim, gap: Gap) -> ClaimResult:
    """Whether the difference is O(h^up_to)."""
    what, ring, x, _ = gap
    assert claim.up_to is not None  # noqa: S101 - the caller's condition
    return differs_below(claim, what, ring, x, claim.up_to) or result(
        claim,
        Verdict.PROVED,
        f"{what} as printed differs from det J − 1 by O(h^{claim.up_to}): the "
        f"difference is {to_text(-grouped(ring, x))}",
    )


def differs_below(claim: Any, what: str, ring: Ring, x: Poly, power: int) -> ClaimResult | None:
    """The claim's result where printed − computed = x is not shown to be O(h^power)."""
    expansion = Expansion(ring, x)
    for n in range(power):
        own, coefficient = expansion.coefficient(n)
        decision = own.decide(coefficient)
        if decision.zero is not True:
            term = H_STEP**n * own.factored(coefficient)
            return _refuted_or_not(claim, what, to_text(term), decision)
    return None


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


CHECKS: Checks = {
    StepMapClaim: check_step_map,
    JacobianClaim: check_jacobian,
    DeltaJClaim: check_delta_j,
}
