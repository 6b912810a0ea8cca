"""What wrong numbers of a table cost: whether a double can tell, which order or accuracy is lost.

The printed numbers are compared with the nearest exact ones in units of a double's last place, one
ulp being 2⁻⁵² times a power of 2. The error constant is the norm of the residues of the order that
comes next, of trees with 1/σ(t). Wrong digits leave residues r of a lower order k: below the step
size at which r h^k is as large as what the method truncates, they are what is seen.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

import flint

from verify.arithmetic.arb import middle_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.prose import Prose, read_prose
from verify.schemes.printed.asked import BITS, Asked, ball_of
from verify.schemes.printed.judged import Judged
from verify.schemes.printed.printed_numbers import entries_at
from verify.verdict import Verdict

_FAR = 1e9  # ulps: more is another number
DOUBLE = Fraction(1, 2**53)  # of a double, half an ulp of 1


class Severity(StrEnum):
    """What kind of mistake it is, the gravest first."""

    WRONG_ORDER = "wrong order"
    NOT_SYMPLECTIC = "not symplectic as claimed"
    WRONG_CLOCK = "wrong clock"
    WRONG_WEIGHTS = "embedded or step weights"
    DIGITS_SEEN = "digits that a double notices"
    DIGITS_BELOW = "digits below that"
    OF_WORDS = "documentation"


@dataclass(frozen=True)
class Cost:
    """`double`: whether a double can tell; None where that is not known. `ulps`: by how many ulps
    the number that is farthest off differs from the nearest exact one. `order`: what it has, in
    place of `claimed`. `error_constant`: as printed, and of the nearest exact numbers. `below`: the
    step size below which wrong digits are what is seen."""

    double: bool | None
    claimed: int | None
    order: int | None
    ulps: float | None
    error_constant: float | None
    nearest_error_constant: float | None
    below: float | None

    @property
    def said(self) -> Prose:
        """A sentence."""
        parts = []
        if self.order is not None and self.claimed is not None:
            parts.append(f"the order: {self.order} in place of {self.claimed}")
        if self.double is False:
            parts.append("nothing that a double can tell")
        elif self.double and self.ulps is not None and self.ulps < _FAR:
            parts.append(
                f"a double can tell: the number farthest off is `{self.ulps:.2g}` ulps from its own"
            )
        if self.below is not None and self.double:
            parts.append(f"below h = `{self.below:.1e}` it is wrong digits that make the error")
        return read_prose("; ".join(parts))


def cost_of(found: Judged, claimed: int | None, following: Asked | None = None) -> Cost | None:
    """None where nothing is wrong. `claimed`: an order, if one is; `following`: the conditions of
    the order after it."""
    right = found.verdict is not Verdict.REFUTED and found.digits is not False
    if right or found.verdict is Verdict.UNDECIDED:
        return None
    ulps = _ulps(found)
    double: bool | None = None
    if ulps is not None:
        double = ulps >= 1
    elif found.largest or found.residue:
        double = max(found.largest, abs(found.residue)) > DOUBLE
    refuted = found.verdict is Verdict.REFUTED
    order = None if claimed is None or not refuted else min(found.order, claimed)
    printed = nearest = below = None
    if following is not None and not refuted:
        printed, nearest = _constants(found, following)
        below = _below(found, claimed, printed)
    return Cost(double, claimed, order, ulps, printed, nearest, below)


def exact_numbers(found: Judged) -> dict[str, Fraction]:
    """The numbers that would do: the nearest, or with the misprinted one mended."""
    if found.nearest is not None:
        return dict(found.nearest)
    if found.misprint is not None:
        return {found.misprint.name: found.misprint.value}
    return {}


def _ulps(found: Judged) -> float | None:
    """None where no numbers that would do are known."""
    if found.read is None:
        return None
    values = found.read.values
    pairs = [(values.get(n), x) for n, x in exact_numbers(found).items()]
    if not pairs or any(y is None for y, _ in pairs):
        return None
    return max(_apart(y, x) for y, x in pairs if y is not None)


def _apart(x: Fraction, y: Fraction) -> float:
    """In ulps of the larger one."""
    return float(abs(x - y) / Fraction(max(math.ulp(float(x)), math.ulp(float(y)))))


def _constants(found: Judged, following: Asked) -> tuple[float | None, float | None]:
    assert found.read is not None  # noqa: S101 - digits are of rounded numbers
    printed = error_constant(following, found.read.values)
    if found.nearest is None:
        return printed, None
    return printed, error_constant(following, {**found.read.values, **found.nearest})


def error_constant(asked: Asked, at: Mapping[str, Fraction]) -> float:
    """The norm of the residues, with their shares."""
    with working_precision(BITS):
        point = {name: flint.arb(flint.fmpq(x.numerator, x.denominator)) for name, x in at.items()}
        entries = entries_at(asked.entries, point, ball_of)
        sizes = [float(middle_and_radius(x)[0]) for x in asked.residues(entries, flint.arb(1))]
    shares = [float(x) for x in asked.shares] or [1.0] * len(sizes)
    return math.hypot(*(x * y for x, y in zip(sizes, shares, strict=True)))


def _below(found: Judged, claimed: int | None, constant: float | None) -> float | None:
    """The largest step size at which some residue of a lower order is as large as what is
    truncated."""
    if claimed is None or not constant:
        return None
    sizes = [
        (abs(float(r)) / constant) ** (1 / (claimed + 1 - e.order))
        for e, r in found.residues
        if e.order <= claimed and r
    ]
    return max(sizes, default=None)


def severity_of(found: Judged, refuted_as: Severity) -> Severity | None:
    """What kind of mistake it is; `refuted_as`: where it is more than digits."""
    if found.verdict is Verdict.REFUTED:
        return refuted_as
    if found.digits is not False:
        return None
    cost = cost_of(found, None)
    return Severity.DIGITS_BELOW if cost and cost.double is False else Severity.DIGITS_SEEN
