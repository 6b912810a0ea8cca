"""Claims about an order in h, what is proved about it, and the verdict on the claimed order."""

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.expressions.formula_text import to_text
from verify.claims.base_claim import Claim, Findings
from verify.claims.formula_claims import condition_text, proof_of, step_map_of, witness_of
from verify.claims.quantified_claims import QuantifiedClaim
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order_conditions import describe_nearby
from verify.proof.order_for_one_h import convergence_of_scheme, leading_of, nearby_defect_of
from verify.proof.printed_formulas import describe_nearby_defect
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.proof_for_one_h import Convergence
from verify.prose import Formula, prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes import get
from verify.schemes.conditions.condition import NearbyOrder
from verify.structures import AREA, SYMPLECTIC
from verify.verdict import Verdict

Order = Annotated[int, Field(ge=1, le=64, strict=True)]
_BEYOND = MOST_ORDERS + 1  # an order of what vanishes


@dataclass(frozen=True)
class ProvedOrder:
    """A proved order in h: at least `least`, and not higher if `exact`.

    `vanishes`: True for the zero function, which has every order; None if that is undecided.
    `evidence` states the order in one line. `domain`: where the map is defined; `exact_for`: the
    parameters for which the order is not higher than `least`. `best_verdict`: the verdict on a
    claimed order that agrees; ENCLOSED or MEASURED if the order is that of exact coefficients
    near printed ones.
    """

    least: int
    exact: bool
    vanishes: bool | None
    evidence: str
    domain: FormulaDomain = EVERYWHERE
    exact_for: FormulaDomain = EVERYWHERE
    best_verdict: Verdict = Verdict.PROVED

    def holds_in(self, order: int, *, at_least: bool) -> FormulaDomain:
        """Return the domain of the verdict, which need not depend on the order being exact."""
        # The domain of a lower bound is that of the map; only exactness restricts the parameters.
        is_settled = self.vanishes or order < self.least or (at_least and order == self.least)
        return self.domain if is_settled else self.domain & self.exact_for

    def verdict(self, order: int, *, at_least: bool) -> Verdict:
        """Decide if the order equals the claimed one, or with `at_least` is not lower."""
        if at_least:
            if order <= self.least or self.vanishes:
                return self.best_verdict
            return Verdict.REFUTED if self.exact else Verdict.UNDECIDED
        # The zero function has every order, so that "exactly this order" is refuted for it.
        if self.vanishes or order < self.least or (self.exact and order != self.least):
            return Verdict.REFUTED
        return self.best_verdict if self.exact else Verdict.UNDECIDED


def vanishing_verdict(vanishes: bool | None, claimed: bool) -> Verdict:
    """Return the verdict on the claim that a defect vanishes, or does not."""
    if vanishes is None:
        return Verdict.UNDECIDED
    return Verdict.PROVED if vanishes == claimed else Verdict.REFUTED


def judge_vanishing(claim: Claim, order: ProvedOrder, claimed: bool) -> ClaimResult:
    """Judge the claim that the function with this order vanishes, or does not."""
    domain = order.domain & order.exact_for
    verdict = vanishing_verdict(order.vanishes, claimed)
    return claim.result(verdict, order.evidence + condition_text(domain), domain=domain)


def with_nearby(order: ProvedOrder, near: NearbyOrder | None) -> ProvedOrder:
    """Return the order with the evidence for exact coefficients near printed ones, if any."""
    if near is None:
        return order
    evidence = prose(order.evidence, "; ", describe_nearby(near))
    return replace(order, evidence=evidence, best_verdict=near.verdict)


class OrderedClaim(QuantifiedClaim):
    """The base of the kinds that claim an order, or with `at_least` a lower bound of one.

    `form`: the form whose order is claimed, S or, in any number of degrees of freedom, det J − 1.
    """

    form: ClassVar[Literal["S", "ΔJ"]] = "S"

    at_least: bool = False
    """True if a higher order is as claimed, too."""

    @property
    def claimed_order(self) -> int:
        """The claimed order, which stands under the name of the kind."""
        return int(getattr(self, self.kind))

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self.judge_proved(order_of(self, findings, self.form))

    def judge_every(self, proof: ProofForEveryH) -> ClaimResult:
        preserves, order = proof.area_preserving, proof.order
        proved_order = ProvedOrder(
            order or 0, order is not None, preserves, proof.reason, proof.domain
        )
        return self.judge_proved(proved_order)

    def judge_proved(self, proved_order: ProvedOrder) -> ClaimResult:
        """Return the verdict on the claimed order, given the proved one."""
        verdict = proved_order.verdict(self.claimed_order, at_least=self.at_least)
        domain = proved_order.holds_in(self.claimed_order, at_least=self.at_least)
        return self.result(verdict, proved_order.evidence + condition_text(domain), domain=domain)

    def for_hamiltonian(self, hamiltonian: Hamiltonian) -> Self:
        """Return the claim of at least this order, for a single H may have a higher one."""
        return self.model_copy(update={"every": None, "at_least": True}) if self.every else self


def order_of(claim: Claim, findings: Findings, form: str) -> ProvedOrder:
    """Return the order of S = JᵀΩJ − Ω, or of ΔJ = det J − 1, of the claim's scheme and H.

    In the plane S is ΔJ·Ω, so that both have the same order.
    """
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    order_in = {AREA: _delta_j_order, SYMPLECTIC: _order_in_degrees}[hamiltonian.structure]
    order = order_in(hamiltonian, claim.scheme, of_s=form == "S")
    form_name = hamiltonian.structure.symbol if form == "S" else form
    return _with_printed(order, claim.scheme, hamiltonian, form_name)


def _with_printed(
    order: ProvedOrder, scheme: str, hamiltonian: Hamiltonian, form: str
) -> ProvedOrder:
    """Return the order for exact coefficients, if a term only comes from rounded printed ones."""
    power = order.least if order.exact else None
    near = nearby_defect_of(get(scheme), hamiltonian, power)
    if near is None:
        return order
    # Rounded printed coefficients leave a tiny term at a low power of h. `near` is the order for
    # exact coefficients close to them, with their first condition that is wrong, if any.
    is_exact = near.wrong is not None
    return replace(
        order,
        least=near.order + 1,
        exact=is_exact,
        vanishes=False if is_exact else None,
        evidence=prose(order.evidence, "; ", describe_nearby_defect(near, form)),
        best_verdict=near.verdict,
    )


def _order_in_degrees(hamiltonian: Hamiltonian, scheme: str, *, of_s: bool) -> ProvedOrder:
    """Return the order of S, or of det J − 1, in several degrees of freedom."""
    proof = proof_of(hamiltonian, scheme)
    vanishes, order = proof.area_preserving, proof.volume_order
    # S of several degrees can vanish only if det J − 1 does; the other way it may not.
    if of_s:
        vanishes, order = proof.symplectic, proof.order
    if order is None:
        sentence = prose("det J ≡ 1" if vanishes else "the order of det J − 1 is not decided")
        evidence = proof.reason if of_s else sentence
        return ProvedOrder(_BEYOND if vanishes else 0, False, vanishes, evidence, proof.domain)
    form, by_entry = ("S", f", by {proof.entry}") if of_s else ("det J − 1", "")
    evidence = prose(f"{form} has order exactly ", Formula(f"h^{order}"), by_entry)
    return ProvedOrder(order, True, False, evidence, proof.domain)


def _delta_j_order(hamiltonian: Hamiltonian, scheme: str, *, of_s: bool) -> ProvedOrder:
    """Return the order of ΔJ in h, which is also that of S in the plane."""
    step_map = step_map_of(hamiltonian, scheme)
    leading = leading_of(step_map).restrict_to(step_map.domain)
    decision = leading.decision
    if decision.zero is True:
        evidence = prose("ΔJ is the zero function: det J ≡ 1")
        return ProvedOrder(_BEYOND, False, True, evidence, step_map.domain)
    power = _BEYOND if leading.power is None else leading.power
    if decision.zero is None or leading.power is None:
        evidence = prose(
            "ΔJ = O(", Formula(f"h^{power}"), "), and whether of higher order is not decided",
            "; ΔJ is not the zero function" if decision.zero is False else "",
        )  # fmt: skip
        return ProvedOrder(power, False, decision.zero, evidence, step_map.domain)
    evidence = prose(
        "ΔJ = (", Formula(to_text(leading.coefficient)), ")·", Formula(f"h^{power}"), " + O(",
        Formula(f"h^{power + 1}"), ")", witness_of(decision, "the coefficient is"),
    )  # fmt: skip
    return ProvedOrder(power, True, False, evidence, step_map.domain, leading.domain)


def flow_agreement(claim: Claim, findings: Findings) -> ProvedOrder:
    """Return the power of h up to which the claim's map agrees with the exact flow."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    if hamiltonian.planar:  # by the map alone: nothing is asked of ΔJ
        step_map = step_map_of(hamiltonian, claim.scheme)
        convergence, near = convergence_of_scheme(step_map, get(claim.scheme))
        return _flow_order(convergence, near, step_map.domain, MOST_ORDERS)
    proof = proof_of(hamiltonian, claim.scheme)
    convergence = Convergence(proof.convergence_order, proof.convergence_decided)
    return _flow_order(convergence, proof.nearby, proof.domain)


def _flow_order(
    convergence: Convergence, near: NearbyOrder | None, domain: FormulaDomain, highest: int = 0
) -> ProvedOrder:
    """Return the order of agreement with the exact flow, with its evidence.

    `highest`: the greatest power of h that was examined, or 0 if that is unknown; it is the proved
    order if all examined powers agree.
    """
    if convergence.order is None:
        orders = f"all orders looked at{f', {highest}' if highest else ''}"
        evidence = prose(f"the map agrees with the exact flow in {orders}")
        return ProvedOrder(highest, False, None, evidence, domain)
    agrees = prose("the map agrees with the exact flow up to ", Formula(f"h^{convergence.order}"))
    if convergence.order < 0:
        agrees = prose("the map does not agree with the exact flow even at h = 0")
    suffix = " and no further" if convergence.decided else "; whether further is not decided"
    exact_for = convergence.exact_for() if convergence.decided else EVERYWHERE
    order = ProvedOrder(
        convergence.order, convergence.decided, False, agrees + suffix, domain, exact_for
    )
    return with_nearby(order, near)
