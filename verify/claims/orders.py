"""Claims that say an order in h, what is proved of it, and what follows for one that is claimed."""

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.expressions.formula_text import to_text
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.formulas import proof_of, step_map_of, within, witness_of
from verify.claims.quantified import QuantifiedClaim
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.by_conditions import told_nearby
from verify.proof.claimed import Convergence
from verify.proof.every_proof import EveryProof
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import convergence_of_scheme, leading_of, nearby_defect_of
from verify.proof.printed_formulas import told_defect
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
    """What is proved of an order: it is at least `least`, and no more than that where `exact`.

    `vanishes`: whether it is that of the zero function, which has every order; None where that is
    not decided. `evidence` says so in one line. `domain`: where the map is defined; `exact_for`:
    the parameters for which it is no more than `least`. `held`: what is said of an order that is as
    claimed; ENCLOSED or MEASURED where it is that of exact coefficients near printed ones.
    """

    least: int
    exact: bool
    vanishes: bool | None
    evidence: str
    domain: Domain = EVERYWHERE
    exact_for: Domain = EVERYWHERE
    held: Verdict = Verdict.PROVED

    def holds_in(self, order: int, *, at_least: bool) -> Domain:
        """Where the verdict holds: it need not depend on that the order is no higher."""
        known = self.vanishes or order < self.least or (at_least and order == self.least)
        return self.domain if known else self.domain & self.exact_for

    def verdict(self, order: int, *, at_least: bool) -> Verdict:
        """Whether the order is this one, or with `at_least` no lower one."""
        if at_least:
            if order <= self.least or self.vanishes:
                return self.held
            return Verdict.REFUTED if self.exact else Verdict.UNDECIDED
        if self.vanishes or order < self.least or (self.exact and order != self.least):
            return Verdict.REFUTED
        return self.held if self.exact else Verdict.UNDECIDED


def as_claimed(vanishes: bool | None, claimed: bool) -> Verdict:
    """Whether a defect vanishes or not, as it is claimed."""
    if vanishes is None:
        return Verdict.UNDECIDED
    return Verdict.PROVED if vanishes == claimed else Verdict.REFUTED


def judge_vanishing(claim: Claim, known: ProvedOrder, claimed: bool) -> ClaimResult:
    """Whether what the order is of vanishes, or does not, as it is claimed."""
    domain = known.domain & known.exact_for
    verdict = as_claimed(known.vanishes, claimed)
    return claim.result(verdict, known.evidence + within(domain), domain=domain)


def told_of(known: ProvedOrder, near: NearbyOrder | None) -> ProvedOrder:
    """What is known of exact coefficients near printed ones, if it is of such."""
    if near is None:
        return known
    evidence = prose(known.evidence, "; ", told_nearby(near))
    return replace(known, evidence=evidence, held=near.verdict)


class OrderedClaim(QuantifiedClaim):
    """The base of the kinds that say an order; with `at_least`, that it is no lower one.

    `form`: of which form it is the order, S or, in any number of degrees of freedom, det J − 1.
    """

    form: ClassVar[Literal["S", "ΔJ"]] = "S"

    at_least: bool = False
    """Whether a higher order is as claimed, too."""

    @property
    def claimed(self) -> int:
        """The order that is claimed, which stands under the name of the kind."""
        return int(getattr(self, self.kind))

    def judge_one(self, findings: Findings) -> ClaimResult:
        return self.judge_known(order_of(self, findings, self.form))

    def judge_every(self, proof: EveryProof) -> ClaimResult:
        preserves, order = proof.area_preserving, proof.order
        known = ProvedOrder(order or 0, order is not None, preserves, proof.reason, proof.domain)
        return self.judge_known(known)

    def judge_known(self, known: ProvedOrder) -> ClaimResult:
        """Whether what is proved is as claimed."""
        verdict = known.verdict(self.claimed, at_least=self.at_least)
        domain = known.holds_in(self.claimed, at_least=self.at_least)
        return self.result(verdict, known.evidence + within(domain), domain=domain)

    def of_one(self, hamiltonian: Hamiltonian) -> Self:
        """An order that is not passed for all H together may well be passed for one."""
        return self.model_copy(update={"every": None, "at_least": True}) if self.every else self


def order_of(claim: Claim, findings: Findings, form: str) -> ProvedOrder:
    """The order of S = JᵀΩJ − Ω of the claim's scheme for its scene's H, or of ΔJ = det J − 1; in
    the plane S is ΔJ·Ω."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    order_in = {AREA: _delta_j_order, SYMPLECTIC: _order_in_degrees}[hamiltonian.structure]
    known = order_in(hamiltonian, claim.scheme, of_s=form == "S")
    told = hamiltonian.structure.defect if form == "S" else form
    return _with_printed(known, claim.scheme, hamiltonian, told)


def _with_printed(
    known: ProvedOrder, scheme: str, hamiltonian: Hamiltonian, form: str
) -> ProvedOrder:
    """The same, of exact coefficients where a term is what the digits of printed ones leave."""
    power = known.least if known.exact else None
    near = nearby_defect_of(get(scheme), hamiltonian, power)
    if near is None:
        return known
    exact = near.wrong is not None
    return replace(
        known,
        least=near.order + 1,
        exact=exact,
        vanishes=False if exact else None,
        evidence=prose(known.evidence, "; ", told_defect(near, form)),
        held=near.verdict,
    )


def _order_in_degrees(hamiltonian: Hamiltonian, scheme: str, *, of_s: bool) -> ProvedOrder:
    """The order of S, or of det J − 1."""
    proof = proof_of(hamiltonian, scheme)
    vanishes, order = proof.area_preserving, proof.volume_order
    if of_s:
        vanishes, order = proof.symplectic, proof.order
    if order is None:
        said = prose("det J ≡ 1" if vanishes else "the order of det J − 1 is not decided")
        evidence = proof.reason if of_s else said
        return ProvedOrder(_BEYOND if vanishes else 0, False, vanishes, evidence, proof.domain)
    what, shown = ("S", f", by {proof.entry}") if of_s else ("det J − 1", "")
    evidence = prose(f"{what} has order exactly ", Formula(f"h^{order}"), shown)
    return ProvedOrder(order, True, False, evidence, proof.domain)


def _delta_j_order(hamiltonian: Hamiltonian, scheme: str, *, of_s: bool) -> ProvedOrder:
    """The order of ΔJ in h, which S has in the plane."""
    step_map = step_map_of(hamiltonian, scheme)
    leading = leading_of(step_map).within(step_map.domain)
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


def flow_of(claim: Claim, findings: Findings) -> ProvedOrder:
    """Up to which power of h its map agrees with the exact flow, in any number of degrees."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    if hamiltonian.planar:  # by the map alone: nothing is asked of ΔJ
        step_map = step_map_of(hamiltonian, claim.scheme)
        found, near = convergence_of_scheme(step_map, get(claim.scheme))
        return _flow_order(found, near, step_map.domain, MOST_ORDERS)
    proof = proof_of(hamiltonian, claim.scheme)
    found = Convergence(proof.convergence_order, proof.convergence_decided)
    return _flow_order(found, proof.nearby, proof.domain)


def _flow_order(
    found: Convergence, near: NearbyOrder | None, domain: Domain, most: int = 0
) -> ProvedOrder:
    """`most`: up to which power of h all agree where all do that were looked at; 0: not known."""
    if found.order is None:
        orders = f"all orders looked at{f', {most}' if most else ''}"
        evidence = prose(f"the map agrees with the exact flow in {orders}")
        return ProvedOrder(most, False, None, evidence, domain)
    agrees = prose("the map agrees with the exact flow up to ", Formula(f"h^{found.order}"))
    if found.order < 0:
        agrees = prose("the map does not agree with the exact flow even at h = 0")
    more = " and no further" if found.decided else "; whether further is not decided"
    exact_for = found.exact_for() if found.decided else EVERYWHERE
    known = ProvedOrder(found.order, found.decided, False, agrees + more, domain, exact_for)
    return told_of(known, near)
