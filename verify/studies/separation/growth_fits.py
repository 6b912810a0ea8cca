"""The growth of rounding and of W with N, and the step size where rounding overtakes truncation.

Growth. Rounding errors of one sign add up to a drift, proportional to N; errors of both signs, as
good as independent, make a random walk, whose size is N^½ (P. Henrici, Discrete Variable Methods,
1962, ch. 1.4). The fit is to the envelope, the greatest |rounding| so far, which neither a change
of sign nor an orbit's oscillation reduces: the slope of its logarithm over log N, at checkpoints
spread evenly in log N. The fit leaves out the first checkpoints, whose maximum is of too few
values, and those at which the envelope is at most 10 times the error bound of the values.

One walk is one draw: a slope fitted to the envelope of a Brownian motion over L = ln(N₂/N₁) has
standard deviation 1.65 L^(−3/2) about ½ (from 1500 simulated walks each for L from 3.5 to 6.2; a
test repeats it), several times what the regression's residuals show, since these are correlated.
The greater of the two is reported as the standard error. The growth is named a random walk if the
interval of 2.5 standard errors each way contains ½, and of 0, ½ and 1 that alone; a drift if it
contains 1 alone; else it is undecided. (Of simulated walks of 2048 values 86 % are named a random
walk, 13 % are left undecided and 1 % are taken for a drift.) Neither need hold: rounded states have
an energy that walks and a phase that adds it up, so that the trajectory's part may well grow like
N^(3/2).

W and the tangent map. W_N = Σ_k M_kᵀ S_k M_k, M_k the tangent map of k steps, so that W can grow
though no step's S does: it is a 2-form, and grows as areas do under M, like σ₁σ₂ of M's two
greatest singular values, which is ‖M‖² at most. If the motion is quasi-periodic ‖M‖ grows like N at
most; the same fit of max |W| decides if W stays bounded or grows like N or N². In chaos ‖M‖ grows
exponentially and no power is fitted: W then grows with the motion. `verify.runs.tangent_growth`
decides if ‖M‖ grew exponentially; if it has hardly grown, that stays undecided. All of this is
measured, and not proved.

Crossover. For each step size, the greatest |truncation| and |rounding| at any checkpoint stand for
the run: Λ of an even-order scheme telescopes to a boundary term, which passes through 0 again and
again, so that the last value alone may be small by chance.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal

from verify.arithmetic.arb import slope
from verify.prose import Number, Prose, prose
from verify.runs.tangent_growth import is_exponential
from verify.studies.separation.chain import Trail

Name = Literal["random walk", "drift", "undecided"]
Law = Literal["bounded", "N", "N²", "exponential", "undecided"]
Motion = Literal["exponential", "polynomial", "undecided"]
_LEAST_VALUES = 8  # a maximum so far is of that many values at least
_LEAST_CHECKPOINTS, _MOST_CHECKPOINTS = 5, 32  # checkpoints of a fit
_DECADES = 1.5  # the least range of N
_NOISE_FACTOR = 10  # a value of a fit is that many times the error bound
_WALK_DEVIATION = 1.65  # of a fitted slope, times L^(−3/2): see the module's docstring
_HALF_WIDTH = 2.5  # standard errors
_NAMES: dict[float, tuple[Name, str]] = {  # the key: the only exponent that the interval contains
    0.0: ("undecided", "0"),
    0.5: ("random walk", "½"),
    1.0: ("drift", "1"),
}
_LAWS: tuple[Law, ...] = ("bounded", "N", "N²")  # the index is the exponent
_LEAST_LAW_WIDTH = 0.25  # an exponent this near to a whole one counts as that
_LEAST_GROWTH = 10  # a motion is classified if ‖M‖² has grown by this factor
_DECADES_OF_LAW = 1.2  # the least range of N
_TOO_FEW_TEXT = "too few checkpoints above noise for a fit"


@dataclass(frozen=True)
class GrowthFit:
    """A fit size ~ N^exponent with its name; the exponent is None if nothing was fitted."""

    exponent: float | None
    standard_error: float | None
    name: str
    reason: Prose

    @property
    def fields(self) -> dict[str, Any]:
        """The fields of results, numbers as decimals."""
        numbers = {"exponent": self.exponent, "standard_error": self.standard_error}
        return vars(self) | {n: None if x is None else f"{x:.3f}" for n, x in numbers.items()}


@dataclass(frozen=True)
class Growth(GrowthFit):
    """The growth of |rounding|, from `first` to `last` steps."""

    name: Name
    first: int
    last: int
    points: int


@dataclass(frozen=True)
class PowerLaw(GrowthFit):
    """The growth of a greatest size."""

    name: Law


@dataclass(frozen=True)
class Crossover:
    """The step size below which rounding is the larger part, and the two that bracket it."""

    step_size: float | None
    bracket: tuple[Fraction, Fraction] | None
    reason: str


class Envelope:
    """The greatest |value| so far at equidistant numbers of steps, with the checkpoints of a fit.

    Each value is known to within `noise`.
    """

    def __init__(self, marks: Sequence[int], values: Sequence[Fraction], noise: Fraction) -> None:
        self.marks, self.tops = marks, Trail.from_values(values).envelope()
        usable = [k for k in self.tops.above(_NOISE_FACTOR * noise) if k + 1 >= _LEAST_VALUES]
        self.chosen = select_log_spaced(usable, [marks[k] for k in usable], _MOST_CHECKPOINTS)
        ends = (self.chosen[0], self.chosen[-1]) if self.chosen else ()
        self.first, self.last = [marks[k] for k in ends] or (0, 0)

    @property
    def reach(self) -> float:
        """The distance from the first to the last of these checkpoints, in ln N."""
        return math.log(self.last / self.first) if self.chosen else 0.0

    def reaches(self, decades: float) -> bool:
        """Return True if the checkpoints are enough for a fit, over so many decades of N."""
        return len(self.chosen) >= _LEAST_CHECKPOINTS and self.reach >= decades * math.log(10)

    def slope(self) -> tuple[float, float]:
        """Return the fitted exponent and its standard error."""
        return slope([(math.log(self.marks[k]), log(self.tops[k])) for k in self.chosen])


def fit_growth(marks: Sequence[int], values: Sequence[Fraction], noise: Fraction) -> Growth:
    """Fit values at equidistant numbers of steps, each known to within `noise`."""
    envelope = Envelope(marks, values, noise)
    span = envelope.first, envelope.last, len(envelope.chosen)
    if not envelope.reaches(_DECADES):
        decades = f"{envelope.reach / math.log(10):.1f}"
        reason = prose(
            f"{len(envelope.chosen)} checkpoints above noise over {decades} decades of N; "
            f"a fit takes {_LEAST_CHECKPOINTS} over {_DECADES}"
        )
        return Growth(None, None, "undecided", reason, *span)
    exponent, scatter = envelope.slope()
    # A walk's residuals are correlated, so that their scatter alone understates the error: the
    # module's text has the standard deviation over L = ln(N₂/N₁).
    error = max(scatter, _WALK_DEVIATION * envelope.reach**-1.5)
    matches = [value for value in _NAMES if abs(exponent - value) <= _HALF_WIDTH * error]
    name = _NAMES[matches[0]][0] if len(matches) == 1 else "undecided"
    holds = " and ".join(_NAMES[value][1] for value in matches) or "neither ½ nor 1"
    reason = prose(*_with_error(exponent, _HALF_WIDTH * error), f" holds {holds}")
    return Growth(exponent, error, name, reason, *span)


def classify_motion(marks: Sequence[int], squares: Sequence[Fraction]) -> Motion:
    """Decide from ‖M‖² if ‖M‖ grew exponentially in this run."""
    if len(marks) < _LEAST_CHECKPOINTS or max(squares) < _LEAST_GROWTH * squares[0]:
        return "undecided"
    is_growing = is_exponential([float(n) for n in marks], [log(x) / 2 for x in squares])
    return "undecided" if is_growing is None else "exponential" if is_growing else "polynomial"


def fit_power_law(
    marks: Sequence[int], values: Sequence[Fraction], noise: Fraction, motion: Motion
) -> PowerLaw:
    """Fit a law to the envelope of values at equidistant numbers of steps, each within `noise`."""
    envelope = Envelope(marks, values, noise)
    if not envelope.tops[-1]:
        return PowerLaw(None, None, "bounded", prose("exactly 0 at every checkpoint"))
    if motion == "exponential":
        return PowerLaw(None, None, "exponential", prose("‖M‖ grows exponentially: no power fits"))
    if not envelope.reaches(_DECADES_OF_LAW):
        return PowerLaw(None, None, "undecided", prose(_TOO_FEW_TEXT))
    exponent, error = envelope.slope()
    width = max(_LEAST_LAW_WIDTH, _HALF_WIDTH * error)
    matches = [k for k in range(len(_LAWS)) if abs(exponent - k) <= width]
    name: Law = _LAWS[matches[0]] if len(matches) == 1 else "undecided"
    comparison = (
        f" is near {matches[0]}" if len(matches) == 1 else " is near no whole exponent, or near two"
    )
    interval = _with_error(exponent, _HALF_WIDTH * error)
    return PowerLaw(exponent, error, name, prose("fitted exponent ", *interval, comparison))


def _with_error(exponent: float, width: float) -> tuple[Number, str, Number]:
    """Return the exponent and its interval as parts of a sentence."""
    return Number(f"{exponent:.3f}"), " ± ", Number(f"{width:.3f}")


def select_log_spaced(indices: Sequence[int], positions: Sequence[int], most: int) -> list[int]:
    """Select at most so many of the indices, spread evenly in the log of increasing `positions`."""
    if len(indices) <= most:
        return list(indices)
    low, high = math.log(positions[0]), math.log(positions[-1])
    goals = [low + (high - low) * k / (most - 1) for k in range(most)]
    chosen, k = [], 0
    for goal in goals:
        while k < len(positions) - 1 and math.log(positions[k]) < goal - 1e-12:
            k += 1
        chosen.append(indices[k])
    return sorted(set(chosen))


def find_crossover(points: Sequence[tuple[Fraction, Fraction, Fraction]]) -> Crossover:
    """Find the step size where rounding overtakes truncation as h falls, by log-log interpolation.

    `points`: h with the greatest |truncation| and |rounding|. The bracket runs from the last of the
    small step sizes at which rounding is the larger to the first of the large ones at which
    truncation is; in between, where noise decides, either may be.
    """
    by_size = sorted(points)
    if len(by_size) < 2:
        return Crossover(None, None, "one step size; a crossover takes a grid of them")
    above = [rounding > truncation for _, truncation, rounding in by_size]
    if all(above):
        return Crossover(None, None, "none in this range: rounding is larger at every step size")
    if not any(above):
        return Crossover(None, None, "none in this range: truncation is larger at every step size")
    if not above[0] or above[-1]:
        end, part = ("smallest", "truncation") if not above[0] else ("largest", "rounding")
        return Crossover(None, None, f"none in this range: {part} is larger at the {end} step size")
    low = above.index(False) - 1
    high = len(above) - above[::-1].index(True)
    (h1, t1, r1), (h2, t2, r2) = by_size[low], by_size[high]
    reason = "between neighbours" if high == low + 1 else "between step sizes where noise decides"
    if 0 in (t1, r2):
        return Crossover(None, (h1, h2), f"{reason}; a part is exactly 0 at one of them")
    # lg of truncation over rounding is 0 at the crossover; it is taken as linear in lg h between
    # the two.
    y1, y2 = log(t1) - log(r1), log(t2) - log(r2)
    share = -y1 / (y2 - y1)
    return Crossover(math.exp(log(h1) + share * (log(h2) - log(h1))), (h1, h2), reason)


def log(x: Fraction) -> float:
    """Return ln x, however small x is."""
    # A Fraction beyond float64's range has no float, but its numerator and denominator, which are
    # integers, have logarithms.
    return math.log(x.numerator) - math.log(x.denominator)
