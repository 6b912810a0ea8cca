"""Claims made of every H, or of every H = T(p) + V(q), held against what is proved for all of them.

"For every H" means: whatever H is. ΔJ = c h^r + … then has a c made of derivatives of H, and c is
not zero for some H; det J ≡ 1 is false where some H has another det J.
"""

import re
from typing import Any

import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import parse, symbol, to_text
from verify.claims.area import ProvedOrder, judge_area, judge_order
from verify.claims.findings import result
from verify.claims.formulas import PRINTED_AS, delta_j_printed, differs_below
from verify.claims.kinds import (
    EVERY_SEPARABLE,
    AreaClaim,
    ConvergenceOrderClaim,
    DeltaJClaim,
    OrderClaim,
)
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.claim import ClaimResult
from verify.schemes import get
from verify.schemes.step_map import H_STEP
from verify.verdict import Verdict

_NAME = re.compile(r"[A-Za-z]\w*")
_DERIVATIVE = re.compile(r"H_([pq]+|\d\d)")  # ∂²H/∂p∂q is H_pq, H_qp or H_11


def check_every(claim: Any) -> ClaimResult:
    """The verdict on a claim with `every`, one of the four kinds that can have it."""
    proof = _proof(claim)
    if isinstance(claim, DeltaJClaim):
        return _delta_j(claim, proof)
    if isinstance(claim, AreaClaim):
        return judge_area(claim, proof.area_preserving, proof.reason)
    if isinstance(claim, OrderClaim):
        if proof.area_preserving is None and proof.order is None:
            return result(claim, Verdict.UNDECIDED, proof.reason)
        known = ProvedOrder(proof.order or 0, proof.order is not None, proof.area_preserving,
                      proof.reason)  # fmt: skip
        return judge_order(claim, claim.order, known)
    assert isinstance(claim, ConvergenceOrderClaim)  # noqa: S101 - the last that has `every`
    if proof.convergence_order is None:
        return result(claim, Verdict.UNDECIDED, proof.reason)
    evidence = f"the map agrees with the exact flow of every H up to h^{proof.convergence_order}"
    # The proof looks one order beyond the scheme's own; what reaches that may reach further.
    exact = proof.convergence_order <= get(claim.scheme).order
    evidence += " and, of some, no further" if exact else "; whether further is not decided"
    known = ProvedOrder(proof.convergence_order, exact, False, evidence)
    return judge_order(claim, claim.convergence_order, known)


def _proof(claim: Any) -> Any:
    """A `verify.proof.every.EveryProof`."""
    from verify.proof.every import prove_every

    return prove_every(claim.scheme, separable=claim.every == EVERY_SEPARABLE)


def _delta_j(claim: DeltaJClaim, proof: Any) -> ClaimResult:
    """Up to the first term, which is what is known of ΔJ for every H."""
    what = PRINTED_AS[claim.kind]
    if proof.area_preserving is not True and (proof.order is None or not proof.leading):
        return result(claim, Verdict.UNDECIDED, proof.reason)
    computed, beyond = sympy.S.Zero, claim.up_to
    if proof.area_preserving is not True:
        computed, beyond = H_STEP**proof.order * _read(claim, proof.leading), proof.order + 1
    printed = delta_j_printed(claim, _read(claim, claim.formula))
    difference = printed - computed
    names = {s.name for s in difference.free_symbols} | {"p", "q", "h"}
    ring, (x,) = embed([difference], sorted(names))
    assert claim.up_to is not None  # noqa: S101 - checked where it is read
    wrong = differs_below(claim, what, ring, x, min(claim.up_to, beyond or claim.up_to))
    if wrong is not None:
        return wrong
    if beyond is not None and claim.up_to > beyond:
        evidence = f"{what}: for every H it is known up to O(h^{beyond}), and so far is as printed"
        return result(claim, Verdict.UNDECIDED, evidence)
    return result(claim, Verdict.PROVED, f"{what} is as printed for every H: {proof.reason}")


def _read(claim: DeltaJClaim, formula: str) -> sympy.Expr:
    """A formula in h, p, q and the derivatives of H, of which a separable H has no mixed ones."""
    found = read_every_formula(claim, formula)
    put = {}
    for s in found.free_symbols:
        if _DERIVATIVE.fullmatch(s.name):
            p_times, q_times = _times(s.name)
            zero = claim.every == EVERY_SEPARABLE and p_times and q_times
            name = "H_" + "p" * p_times + "q" * q_times
            put[s] = sympy.S.Zero if zero else symbol(name)
    return found.xreplace(put)


def _times(name: str) -> tuple[int, int]:
    """How often a derivative is taken by p, and by q."""
    by = name.partition("_")[2]
    return (int(by[0]), int(by[1])) if by.isdecimal() else (by.count("p"), by.count("q"))


def of_hamiltonian(claim: DeltaJClaim, hamiltonian: Hamiltonian) -> str:
    """The claim's formula with the derivatives of this H put in. InputError where it is too long
    to be read, or names more than derivatives."""
    found = read_every_formula(claim, claim.formula)
    put = {}
    for s in found.free_symbols:
        if _DERIVATIVE.fullmatch(s.name):
            p_times, q_times = _times(s.name)
            put[s] = hamiltonian.exact.diff((symbol("p"), p_times), (symbol("q"), q_times))
    return to_text(found.xreplace(put))


def read_every_formula(claim: DeltaJClaim, formula: str) -> sympy.Expr:
    """The formula as an expression; InputError where it names more than derivatives of H."""
    derivatives = {name for name in _NAME.findall(formula) if _DERIVATIVE.fullmatch(name)}
    key = f"claim {claim.id}: formula"
    try:
        return parse(formula, ("p", "q", "h", *derivatives), source=key)
    except InputError as error:
        if "unknown name" not in error.problem:
            raise
        problem = f"{error.problem.partition(';')[0]}; allowed: h and derivatives such as H_pq"
        raise InputError(key, formula, problem) from None
