"""What is proved of an order in h, and what follows for one that is claimed."""

from dataclasses import dataclass, replace

from verify.algebra.domain import EVERYWHERE, Domain
from verify.proof.by_conditions import told_nearby
from verify.prose import prose
from verify.schemes.conditions import NearbyOrder
from verify.verdict import Verdict


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


def told_of(known: ProvedOrder, near: NearbyOrder | None) -> ProvedOrder:
    """What is known of exact coefficients near printed ones, if it is of such."""
    if near is None:
        return known
    evidence = prose(known.evidence, "; ", told_nearby(near))
    return replace(known, evidence=evidence, held=near.verdict)
