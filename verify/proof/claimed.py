"""The comparison of what is proved of a map for one H with what its scheme claims."""

from collections.abc import Callable
from dataclasses import dataclass, field

from verify.algebra.domain import EVERYWHERE, Domain
from verify.prose import Prose, read_prose
from verify.schemes.scheme import Scheme
from verify.structures import Structure
from verify.verdict import Verdict


@dataclass(frozen=True)
class Convergence:
    """The power of h up to which p' and q' agree with the exact flow, shown by algebra.

    `order` is None where all coefficients looked at agree, and −1 where they differ at h⁰.
    `decided`: the next coefficient is shown to differ (or there is none), for the parameters in
    `exact_for`.
    """

    order: int | None
    decided: bool
    exact_for: Callable[[], Domain] = field(default=lambda: EVERYWHERE, repr=False)

    def misses(self, claimed: int) -> bool:
        return self.order is not None and self.order < claimed


@dataclass(frozen=True)
class SchemeClaims:
    """The claims about a map: its order, and that it is symplectic.

    `name` is empty for a map that is no named scheme.
    """

    name: str = ""
    order: int = 1
    symplectic: bool = False

    @classmethod
    def from_scheme(cls, scheme: Scheme) -> "SchemeClaims":
        """Return the claims of a scheme; a name that is a user's formulas is quoted."""
        name = f"`{scheme.name}`" if "=" in scheme.name else scheme.name
        return cls(name, scheme.order, scheme.area_preserving)


def judge_claims(
    claimed: SchemeClaims,
    convergence: Convergence,
    defect: tuple[int | None, bool | None],
    most: int,
    structure: Structure,
) -> tuple[Verdict, Prose]:
    """Return the verdict on the claims, and the reason for it.

    `defect`: the power of h in the first coefficient of the defect that is not shown to vanish,
    up to h^`most`, and whether the defect is zero.
    """
    verdict, reason = _judge_order(claimed, convergence) or _judge_defect(
        claimed, *defect, most, structure
    )
    return verdict, read_prose(reason)


def _judge_order(claimed: SchemeClaims, convergence: Convergence) -> tuple[Verdict, str] | None:
    """Return the verdict on the order, or None where the map has the order that is claimed."""
    if not convergence.misses(claimed.order):
        return None
    agreement = f"agrees with the exact flow up to `h^{convergence.order}`"
    if convergence.order == -1:
        agreement = "agrees with the exact flow not even at h = 0"
    if not convergence.decided:
        return Verdict.UNDECIDED, f"the map {agreement}; whether further is not decided"
    if claimed.name:
        claims = f"{claimed.name} claims order {claimed.order}"
        return Verdict.REFUTED, f"{claims}; the map {agreement} only"
    # A map without a scheme claims order 1: one that misses it does not approximate the flow at
    # all.
    only = "" if convergence.order == -1 else " only"
    return Verdict.REFUTED, f"not a scheme for this H: the map {agreement}{only}"


def _judge_defect(
    claimed: SchemeClaims, power: int | None, zero: bool | None, most: int, structure: Structure
) -> tuple[Verdict, str]:
    name = structure.defect
    if zero:
        return Verdict.PROVED, structure.vanishes
    if zero is None:
        what = f"of `h^{power}`" if power is not None else f"beyond `h^{most}`"
        sentence = f"the coefficient {what} in {name} is neither shown to vanish nor not to"
        return Verdict.UNDECIDED, sentence
    not_zero = (
        f"{name} is not the zero {structure.zero}, and its coefficients up to `h^{most}` vanish"
    )
    if claimed.symplectic:
        fact = not_zero if power is None else f"{name} has order {power}"
        return Verdict.REFUTED, f"{claimed.name} claims {structure.claim}; {fact}"
    if power is None:
        return Verdict.PROVED, not_zero
    return Verdict.PROVED, (
        f"the coefficients of {name} below `h^{power}` vanish identically, that of `h^{power}` "
        "does not"
    )
