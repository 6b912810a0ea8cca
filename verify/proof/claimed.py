"""What is proved of a map for one H, held against what is claimed of it."""

from collections.abc import Callable
from dataclasses import dataclass, field

from verify.algebra.domain import EVERYWHERE, Domain
from verify.prose import Prose, read_prose
from verify.schemes.scheme import Scheme
from verify.structures import Structure
from verify.verdict import Verdict


@dataclass(frozen=True)
class Convergence:
    """p', q' agree with the exact flow up to h^order, shown by algebra; None: in all looked at.

    `decided`: the next coefficient is shown to differ (or there is none), for the parameters in
    `exact_for`. −1: they differ at h⁰.
    """

    order: int | None
    decided: bool
    exact_for: Callable[[], Domain] = field(default=lambda: EVERYWHERE, repr=False)

    def misses(self, claimed: int) -> bool:
        return self.order is not None and self.order < claimed


@dataclass(frozen=True)
class Claimed:
    """What is claimed of a map: its order, and whether it is symplectic; "" of a map without a
    name."""

    name: str = ""
    order: int = 1
    symplectic: bool = False

    @classmethod
    def of(cls, scheme: Scheme) -> "Claimed":
        """What the scheme claims; its name is quoted where it is a user's formulas."""
        name = f"`{scheme.name}`" if "=" in scheme.name else scheme.name
        return cls(name, scheme.order, scheme.area_preserving)


def held_to(
    claimed: Claimed,
    convergence: Convergence,
    defect: tuple[int | None, bool | None],
    most: int,
    structure: Structure,
) -> tuple[Verdict, Prose]:
    """The verdict, and the reason for it.

    `defect`: the power of h in its first coefficient that is not shown to vanish, up to h^`most`,
    and whether it is zero.
    """
    verdict, said = _missed(claimed, convergence) or _of_defect(claimed, *defect, most, structure)
    return verdict, read_prose(said)


def _missed(claimed: Claimed, convergence: Convergence) -> tuple[Verdict, str] | None:
    """Where the map is not shown to have the order that is claimed."""
    if not convergence.misses(claimed.order):
        return None
    known = f"agrees with the exact flow up to `h^{convergence.order}`"
    if convergence.order == -1:
        known = "agrees with the exact flow not even at h = 0"
    if not convergence.decided:
        return Verdict.UNDECIDED, f"the map {known}; whether further is not decided"
    if claimed.name:
        claims = f"{claimed.name} claims order {claimed.order}"
        return Verdict.REFUTED, f"{claims}; the map {known} only"
    only = "" if convergence.order == -1 else " only"
    return Verdict.REFUTED, f"not a scheme for this H: the map {known}{only}"


def _of_defect(
    claimed: Claimed, power: int | None, zero: bool | None, most: int, structure: Structure
) -> tuple[Verdict, str]:
    name = structure.defect
    if zero:
        return Verdict.PROVED, structure.vanishes
    if zero is None:
        what = f"of `h^{power}`" if power is not None else f"beyond `h^{most}`"
        said = f"the coefficient {what} in {name} is neither shown to vanish nor not to"
        return Verdict.UNDECIDED, said
    not_zero = (
        f"{name} is not the zero {structure.zero}, and its coefficients up to `h^{most}` vanish"
    )
    if claimed.symplectic:
        found = not_zero if power is None else f"{name} has order {power}"
        return Verdict.REFUTED, f"{claimed.name} claims {structure.claim}; {found}"
    if power is None:
        return Verdict.PROVED, not_zero
    return Verdict.PROVED, (
        f"the coefficients of {name} below `h^{power}` vanish identically, that of `h^{power}` "
        "does not"
    )
