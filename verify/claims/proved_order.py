"""What is proved of an order in h, and what follows for one that is claimed."""

from dataclasses import dataclass

from verify.algebra.domain import EVERYWHERE, Domain
from verify.verdict import Verdict


@dataclass(frozen=True)
class ProvedOrder:
    """What is proved of an order: it is at least `least`, and no more than that where `exact`.

    `vanishes`: whether it is that of the zero function, which has every order; None where that is
    not decided. `evidence` says so in one line. `domain`: where the map is defined; `exact_for`:
    the parameters for which it is no more than `least`.
    """

    least: int
    exact: bool
    vanishes: bool | None
    evidence: str
    domain: Domain = EVERYWHERE
    exact_for: Domain = EVERYWHERE

    def holds_in(self, order: int, *, at_least: bool) -> Domain:
        """Where the verdict holds: it need not depend on that the order is no higher."""
        known = self.vanishes or order < self.least or (at_least and order == self.least)
        return self.domain if known else self.domain & self.exact_for

    def verdict(self, order: int, *, at_least: bool) -> Verdict:
        """Whether the order is this one, or with `at_least` no lower one."""
        if at_least:
            if order <= self.least or self.vanishes:
                return Verdict.PROVED
            return Verdict.REFUTED if self.exact else Verdict.UNDECIDED
        if self.vanishes or order < self.least or (self.exact and order != self.least):
            return Verdict.REFUTED
        return Verdict.PROVED if self.exact else Verdict.UNDECIDED
