"""A scheme's clocks, for H that depend on time: conditions with them, and mistakes with a name.

    conditions = conditions_for(scheme.every_h, Kinetic.MASS)

A scheme without specified times has the right ones. A scheme that is a Taylor series, as `lieη`,
has no coefficients for conditions: its order is η, with D = ∂_t + X in place of X.

The times at which kicks and drifts are taken are compared with those that common mistakes would
give. If all times that are read agree with those of a mistake, that mistake is named.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import flint
import sympy

from verify.algebra.enclosure import enclose_defined
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.schemes.conditions.every_hamiltonian import RungeKutta, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.splitting_conditions import Splitting, sums_before
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.conditions.words.words import Kinetic

_PRECISION = 192


def conditions_for(
    every_h: object,
    kinetic: Kinetic | None = None,
    times: Sequence[sympy.Expr | int | None] = (),
) -> Splitting | TreeConditions:
    """Return the conditions of `Scheme.every_h`, for every H = T + V(q, t) with T of the class.

    `kinetic`: the class of T; None for every H(p, q, t) that the scheme takes. `times`: that of
    each part or stage, in parts of h, None for the right one; if left out, those of the scheme
    itself. Raises InputError for a scheme without coefficients.
    """
    if isinstance(every_h, Splitting):
        return every_h.in_time(kinetic, tuple(times))
    if isinstance(every_h, TreeConditions):
        tableau = every_h.tableau
    elif isinstance(every_h, RungeKutta):
        count = len(every_h.weights)
        rows = [[*row, *[0] * (count - len(row))] for row in every_h.rows]
        tableau = ImplicitTableau.from_numbers(rows, every_h.weights)
    elif isinstance(every_h, StageEquations):
        tableau = _tableau_of_stages(every_h)
    else:
        raise InputError("scheme", type(every_h).__name__, "is not given by coefficients")
    general = Kinetic.GENERAL if every_h.separable else None
    return TreeConditions(tableau.with_times(times or None), kinetic or general)


def _tableau_of_stages(equations: StageEquations) -> ImplicitTableau:
    """Return the tableau of stages that are solved one after the other.

    It is partitioned unless the coefficients of p and of q are the same.
    """
    of_p = _sequential_tableau([(s.kick, s.at_p) for s in equations.stages])
    of_q = _sequential_tableau([(s.drift, s.at_q) for s in equations.stages])
    return of_p if of_p == of_q else replace(of_p, of_q=of_q)


def _sequential_tableau(stages: Sequence[tuple[Fraction, Fraction]]) -> ImplicitTableau:
    """Return the tableau of z_i = z_(i−1) + h b_i f(z_(i−1) + at_i (z_i − z_(i−1)))."""
    weights = [weight for weight, _ in stages]
    rows = [
        [*weights[:i], share * weight, *[0] * (len(stages) - i - 1)]
        for i, (weight, share) in enumerate(stages)
    ]
    return ImplicitTableau.from_numbers(rows, weights)


# -- mistakes with a name -------------------------------------------------------------------------


@dataclass(frozen=True)
class ClockReading:
    """The `times` at which a `quantity` is read in each `part`; `right` are the right times.

    A part is a kick or a drift. `sizes`: the part of h that each takes; one of size 0 reads
    nothing. `own_kind_sums`: for each, the sum of the earlier parts of its own kind.
    """

    ring: Ring
    quantity: str
    part: str
    times: Sequence[Poly]
    right: Sequence[Poly]
    own_kind_sums: Sequence[Poly]
    sizes: Sequence[Poly]


def find_mistakes(splitting: Splitting, tolerance: Fraction = Fraction(0)) -> list[str]:
    """Return the mistakes in the clocks of the kicks and of the drifts, in words.

    Drifts count only if T depends on time. `tolerance`: by how much equal times may differ; it is
    positive for measured clocks. The list is empty if no clock is wrong in a way that has a name.
    """
    names = (mistake_of_clock(reading, tolerance) for reading in _readings_of(splitting))
    return [name for name in names if name is not None]


def _readings_of(splitting: Splitting) -> Iterator[ClockReading]:
    ring, parts = splitting.numbers
    for letter, quantity, part in (("K", "force", "kick"), ("D", "velocity", "drift")):
        if splitting.kinetic and letter in splitting.kinetic.timed_letters:
            timed_parts = list(zip(parts, splitting.right, strict=True))
            sizes = [size for (kind, size, _), _ in timed_parts if kind == letter]
            times = [time for (kind, _, time), _ in timed_parts if kind == letter]
            clocks = [clock for (kind, *_), clock in timed_parts if kind == letter]
            own_sums = sums_before([(letter, size) for size in sizes], ring.zero, same_kind=True)
            yield ClockReading(ring, quantity, part, times, clocks, own_sums, sizes)


def mistake_of_clock(reading: ClockReading, tolerance: Fraction) -> str | None:
    """Return the mistake that explains the times; None if they are right or none explains them."""
    ring = reading.ring
    # A part of size 0 reads nothing, so its time cannot be wrong.
    read = [k for k, size in enumerate(reading.sizes) if not size.is_zero()]

    def same(times: Sequence[Poly], clock: Sequence[Poly]) -> bool:
        return all(_alike(ring, times[k] - clock[k], tolerance) for k in read)

    if same(reading.times, reading.right):
        return None
    for name, clock in MISTAKES.items():
        if same(reading.times, clock(reading)):
            return name.format(quantity=reading.quantity, part=reading.part)
    return None


def _alike(ring: Ring, gap: Poly, tolerance: Fraction) -> bool:
    if tolerance == 0:
        return ring.decide(gap).zero is True
    ball = enclose_defined(ring, ring.reduce(gap), {}, _PRECISION)
    return bool(abs(ball) <= flint.fmpq(tolerance.numerator, tolerance.denominator))


def _middle_at(reading: ClockReading, time: int) -> list[Poly]:
    """Return the right times, with `time` in place of 1/2."""
    ring, half = reading.ring, reading.ring.one / 2
    due = [ring.decide(clock - half).zero is True for clock in reading.right]
    return [ring.one * time if d else x for d, x in zip(due, reading.right, strict=True)]


def _own_kind_after(reading: ClockReading) -> list[Poly]:
    """Return for each part the sum of the parts of its own kind up to and including it."""
    sizes = zip(reading.own_kind_sums, reading.sizes, strict=True)
    return [reading.ring.reduce(before + size) for before, size in sizes]


# The first mistake that fits is named: several may fit, as for a single kick.
MISTAKES: Mapping[str, Callable[[ClockReading], Sequence[Poly]]] = {
    "as if the {quantity} were read at t in every {part}": lambda r: [r.ring.zero] * len(r.right),
    "as if the {quantity} were read at the step's end in every {part}": (
        lambda r: [r.ring.one] * len(r.right)
    ),
    "as if the {quantity} were read at the step's middle in every {part}": (
        lambda r: [r.ring.one / 2] * len(r.right)
    ),
    "the {quantity} in the step's middle is read at its end": lambda r: _middle_at(r, 1),
    "the {quantity} in the step's middle is read at its start": lambda r: _middle_at(r, 0),
    "as if each {part} read the clock of its own kind: kick and drift exchanged": lambda r: (
        r.own_kind_sums
    ),
    "as if each {part} read the clock of its own kind, after it: kick and drift exchanged": (
        _own_kind_after
    ),
    "every {part} reads the time of the one before it": lambda r: [r.ring.zero, *r.right[:-1]],
    "every {part} reads the time of the one after it": lambda r: [*r.right[1:], r.ring.one],
    "as if time ran backwards in the step": lambda r: [r.ring.one - x for x in r.right],
}
