"""Conditions on a scheme's coefficients, evaluated exactly, each with its residual."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol, runtime_checkable

from verify.prose import Prose
from verify.verdict import Verdict


@dataclass(frozen=True)
class Condition:
    """One equation between coefficients: `name` says which, e.g. "Σ b_i c_i = 1/2".

    `order`: the power of h that needs it; 0 where it is about area or symmetry. `residue`: left
    side − right side, "0" where it is exactly 0, else a decimal that is known to its last digit.
    `holds`: exactly so; None where that is not decided.
    """

    name: str
    order: int
    residue: str
    holds: bool | None


@dataclass(frozen=True)
class NearbyOrder:
    """The highest order that exact coefficients near printed ones have, with the evidence for it.

    `explanation`: how near they are, and the residuals that the digits leave. `wrong`: a condition
    of the next order that none near them satisfy; None where that is not decided. `parts`: the
    nearest, to some 90 digits; none where they are not known. `times`: those of the nearest, None
    where it is the right one; none where all are.
    """

    order: int
    verdict: Verdict
    said: Prose
    wrong: Condition | None
    parts: tuple[tuple[str, Fraction], ...]
    times: tuple[Fraction | None, ...] = ()


@runtime_checkable
class ByConditions(Protocol):
    """A scheme for every H (`separable`: every H = T(p) + V(q)) that is defined by coefficients."""

    @property
    def separable(self) -> bool: ...

    @property
    def most_order(self) -> int:
        """The highest order of which there are conditions; `order_conditions` raises InputError
        beyond it."""
        ...

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Return all conditions that make the map agree with the exact flow up to h^order, for
        every H.

        Where those of lower orders hold and one of h^r does not, there is an H for which the map
        does not agree with the flow up to h^r.
        """
        ...

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return all conditions that make det J ≡ 1 for every H; they suffice."""
        ...
