"""Claims that say an order in h, and what is proved of such an order."""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field

from verify.algebra.domain import EVERYWHERE
from verify.algebra.expressions.formula_text import to_text
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.formulas import step_map_of, within, witness_of
from verify.claims.orders_in_degrees import defect_order, flow_order, volume_order
from verify.claims.proved_order import ProvedOrder, told_of
from verify.claims.quantified import QuantifiedClaim
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import convergence_of_scheme, leading_of, nearby_defect_of
from verify.proof.printed_formulas import told_defect
from verify.prose import Formula, prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes import get
from verify.schemes.scheme import Scheme
from verify.schemes.step_map import StepMap

if TYPE_CHECKING:
    from verify.claims.checked import AboutAll
    from verify.proof.every_proof import EveryProof

Order = Annotated[int, Field(ge=1, le=64, strict=True)]
OF_DELTA_J: "AboutAll" = frozenset({"volume"})
OF_S: "AboutAll" = frozenset({"defect"})
OF_MAP: "AboutAll" = frozenset({"map"})
OF_LAMBDA: "AboutAll" = frozenset({"product"})


class OrderedClaim(QuantifiedClaim):
    """The base of the kinds that say an order; with `at_least`, that it is no lower one."""

    at_least: bool = False
    """Whether a higher order is as claimed, too."""

    @property
    def claimed(self) -> int:
        """The order that is claimed, which stands under the name of the kind."""
        return int(getattr(self, self.kind))

    def judge_known(self, known: ProvedOrder) -> ClaimResult:
        """Whether what is proved is as claimed."""
        verdict = known.verdict(self.claimed, at_least=self.at_least)
        domain = known.holds_in(self.claimed, at_least=self.at_least)
        return self.result(verdict, known.evidence + within(domain), domain=domain)

    def of_one(self, hamiltonian: Hamiltonian) -> Self:
        """An order that is not passed for all H together may well be passed for one."""
        return self.model_copy(update={"every": None, "at_least": True}) if self.every else self


def every_delta_j(proof: "EveryProof") -> ProvedOrder:
    """The order of ΔJ for every H."""
    preserves, order = proof.area_preserving, proof.order
    return ProvedOrder(order or 0, order is not None, preserves, proof.reason, proof.domain)


def delta_j_of(claim: Claim, findings: Findings) -> ProvedOrder:
    """The order of ΔJ of the claim's scheme for its scene's H, in any number of degrees."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    if hamiltonian.planar:
        known = delta_j_order(step_map_of(hamiltonian, claim.scheme))
    else:
        known = volume_order(hamiltonian, claim.scheme)
    return _with_printed(known, claim.scheme, hamiltonian, "ΔJ")


def defect_of(claim: Claim, findings: Findings) -> ProvedOrder:
    """The order of S = JᵀΩJ − Ω, which in the plane is ΔJ·Ω."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    if hamiltonian.planar:
        return delta_j_of(claim, findings)
    known = defect_order(hamiltonian, claim.scheme)
    return _with_printed(known, claim.scheme, hamiltonian, "S")


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


def flow_of(claim: Claim, findings: Findings) -> ProvedOrder:
    """Up to which power of h its map agrees with the exact flow, in any number of degrees."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    if hamiltonian.planar:
        return convergence_order(step_map_of(hamiltonian, claim.scheme), get(claim.scheme))
    return flow_order(hamiltonian, claim.scheme)


def delta_j_order(step_map: StepMap) -> ProvedOrder:
    """The order of ΔJ in h."""
    leading = leading_of(step_map).within(step_map.domain)
    beyond, decision = MOST_ORDERS + 1, leading.decision
    if decision.zero is True:
        evidence = prose("ΔJ is the zero function: det J ≡ 1")
        return ProvedOrder(beyond, False, True, evidence, step_map.domain)
    power = beyond if leading.power is None else leading.power
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


def convergence_order(step_map: StepMap, scheme: Scheme | None = None) -> ProvedOrder:
    """To which power of h the map agrees with the exact flow."""
    found, near = convergence_of_scheme(step_map, scheme)
    if found.order is None:
        evidence = f"the map agrees with the exact flow in all orders looked at, {MOST_ORDERS}"
        return ProvedOrder(MOST_ORDERS, False, None, evidence, step_map.domain)
    agrees = prose("the map agrees with the exact flow up to ", Formula(f"h^{found.order}"))
    if found.order < 0:
        agrees = prose("the map does not agree with the exact flow even at h = 0")
    more = " and no further" if found.decided else "; whether further is not decided"
    exact_for = found.exact_for() if found.decided else EVERYWHERE
    known = ProvedOrder(
        found.order, found.decided, False, agrees + more, step_map.domain, exact_for
    )
    return told_of(known, near)
