"""The cost of wrong numbers in a table: does a double notice, which order or accuracy is lost?

The printed numbers are compared with the nearest exact ones in ulps, units of a double's last
place: 2⁻⁵² times a power of 2. The error constant is the norm of the residuals of the conditions of
the next order, each of a tree t with the factor 1/σ(t). Wrong digits leave residuals r of a lower
order k. Below the step size at which r h^k is as large as the truncation error, they make the error
of a step.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

import flint

from verify.arithmetic.arb import midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.prose import Prose, read_prose
from verify.schemes.printed.condition_set import BITS, ConditionSet, ball_of
from verify.schemes.printed.judgement import Judgement
from verify.schemes.printed.printed_numbers import entries_at
from verify.verdict import Verdict

_MAX_ULPS = 1e9  # beyond, the printed number is another one, and no rounding
DOUBLE = Fraction(1, 2**53)  # the unit roundoff of a double


class Severity(StrEnum):
    """The kind of a mistake, the gravest first."""

    WRONG_ORDER = "wrong order"
    NOT_SYMPLECTIC = "not symplectic as claimed"
    WRONG_CLOCK = "wrong clock"
    WRONG_WEIGHTS = "embedded or step weights"
    DIGITS_SEEN = "digits that a double notices"
    DIGITS_BELOW = "digits below that"
    OF_WORDS = "documentation"


@dataclass(frozen=True)
class Cost:
    """The cost of a mistake in the numbers of a table.

    `double`: True if a double can tell the printed numbers from the exact ones; None if that is not
    known. `ulps`: the largest difference of a number from the nearest exact one, None if no exact
    numbers are known. `order`: that of the table, in place of `claimed`. `error_constant`: that of
    the printed numbers, and `nearest_error_constant` that of the nearest exact ones. `below`: the
    step size below which wrong digits make the error of a step.
    """

    double: bool | None
    claimed: int | None
    order: int | None
    ulps: float | None
    error_constant: float | None
    nearest_error_constant: float | None
    below: float | None

    @property
    def sentence(self) -> Prose:
        """A sentence on the cost."""
        parts = []
        if self.order is not None and self.claimed is not None:
            parts.append(f"the order: {self.order} in place of {self.claimed}")
        if self.double is False:
            parts.append("nothing that a double can tell")
        elif self.double and self.ulps is not None and self.ulps < _MAX_ULPS:
            parts.append(
                f"a double can tell: the number farthest off is `{self.ulps:.2g}` ulps from its own"
            )
        if self.below is not None and self.double:
            parts.append(f"below h = `{self.below:.1e}` it is wrong digits that make the error")
        return read_prose("; ".join(parts))


def cost_of(
    judgement: Judgement, claimed: int | None, following: ConditionSet | None = None
) -> Cost | None:
    """Return the cost of what is wrong; None where nothing is. `claimed`: an order, if one is
    claimed; `following`: the conditions of the order after it."""
    right = judgement.verdict is not Verdict.REFUTED and judgement.digits is not False
    if right or judgement.verdict is Verdict.UNDECIDED:
        return None
    ulps = _ulps(judgement)
    double: bool | None = None
    if ulps is not None:
        double = ulps >= 1
    elif judgement.largest_residual or judgement.residual:
        double = max(judgement.largest_residual, abs(judgement.residual)) > DOUBLE
    refuted = judgement.verdict is Verdict.REFUTED
    order = None if claimed is None or not refuted else min(judgement.order, claimed)
    printed = nearest = below = None
    if following is not None and not refuted:
        printed, nearest = _constants(judgement, following)
        below = _find_step_below(judgement, claimed, printed)
    return Cost(double, claimed, order, ulps, printed, nearest, below)


def exact_numbers(judgement: Judgement) -> dict[str, Fraction]:
    """Return numbers that would be right: the nearest ones, or the misprinted one corrected."""
    if judgement.nearest is not None:
        return dict(judgement.nearest)
    if judgement.misprint is not None:
        return {judgement.misprint.name: judgement.misprint.value}
    return {}


def _ulps(judgement: Judgement) -> float | None:
    """Return the largest distance in ulps; None where no right numbers are known."""
    if judgement.numbers is None:
        return None
    values = judgement.numbers.values
    pairs = [(values.get(n), x) for n, x in exact_numbers(judgement).items()]
    if not pairs or any(y is None for y, _ in pairs):
        return None
    return max(_apart(y, x) for y, x in pairs if y is not None)


def _apart(x: Fraction, y: Fraction) -> float:
    """Return the distance in ulps of the larger number."""
    return float(abs(x - y) / Fraction(max(math.ulp(float(x)), math.ulp(float(y)))))


def _constants(judgement: Judgement, following: ConditionSet) -> tuple[float | None, float | None]:
    assert judgement.numbers is not None  # noqa: S101 - digits are of rounded numbers
    printed = error_constant(following, judgement.numbers.values)
    if judgement.nearest is None:
        return printed, None
    return printed, error_constant(following, {**judgement.numbers.values, **judgement.nearest})


def error_constant(conditions: ConditionSet, values: Mapping[str, Fraction]) -> float:
    """Return the norm of the residuals, each with its share."""
    with working_precision(BITS):
        point = {
            name: flint.arb(flint.fmpq(x.numerator, x.denominator)) for name, x in values.items()
        }
        entries = entries_at(conditions.entries, point, ball_of)
        sizes = [
            float(midpoint_and_radius(x)[0]) for x in conditions.residuals(entries, flint.arb(1))
        ]
    # Conditions by words have no symmetry factors: each counts as 1.
    shares = [float(x) for x in conditions.error_weights] or [1.0] * len(sizes)
    return math.hypot(*(x * y for x, y in zip(sizes, shares, strict=True)))


def _find_step_below(
    judgement: Judgement, claimed: int | None, constant: float | None
) -> float | None:
    """Return the largest step size at which some residual of a lower order is as large as what is
    truncated."""
    if claimed is None or not constant:
        return None
    sizes = [
        # A residual r of order k and the truncated term C h^(p+1) are equal at h =
        # (r/C)^(1/(p+1−k)).
        (abs(float(r)) / constant) ** (1 / (claimed + 1 - e.order))
        for e, r in judgement.residuals
        if e.order <= claimed and r
    ]
    return max(sizes, default=None)


def severity_of(judgement: Judgement, refuted_as: Severity) -> Severity | None:
    """Return the kind of mistake; `refuted_as`: where it is more than digits."""
    if judgement.verdict is Verdict.REFUTED:
        return refuted_as
    if judgement.digits is not False:
        return None
    cost = cost_of(judgement, None)
    return Severity.DIGITS_BELOW if cost and cost.double is False else Severity.DIGITS_SEEN
