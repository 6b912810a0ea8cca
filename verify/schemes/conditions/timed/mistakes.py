"""Clocks that are wrong in a way that has a name.

The times at which kicks, drifts or stages are taken are compared with those that a common mistake
would give. Where all times that are read agree with one, that mistake is named.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.algebra.enclosure import enclose_defined
from verify.algebra.ring import Poly, Ring
from verify.schemes.conditions.splitting_conditions import Splitting, sums_before

_PRECISION = 192


@dataclass(frozen=True)
class Reading:
    """Function values read at `times`, where `right` are the right ones: a force in kicks, say.

    `sizes`: the part of h that each takes; a part of 0 reads nothing. `own_kind_sums`: the sums of
    the parts of its own kind before each.
    """

    ring: Ring
    what: str
    where: str
    times: Sequence[Poly]
    right: Sequence[Poly]
    own_kind_sums: Sequence[Poly]
    sizes: Sequence[Poly]


def find_mistakes(splitting: Splitting, tolerance: Fraction = Fraction(0)) -> list[str]:
    """Return the mistakes of the kicks and, where their time counts, of the drifts, in words.

    `tolerance`: how far two times may differ, 0 for exactly; positive for clocks that were
    measured. Empty where the clocks are right, or wrong in no way that has a name.
    """
    names = (name_of(reading, tolerance) for reading in _of_parts(splitting))
    return [name for name in names if name is not None]


def _of_parts(splitting: Splitting) -> Iterator[Reading]:
    ring, parts = splitting.numbers
    for letter, what, where in (("K", "force", "kick"), ("D", "velocity", "drift")):
        if splitting.kinetic and letter in splitting.kinetic.timed_letters:
            both = list(zip(parts, splitting.right, strict=True))
            sizes = [size for (kind, size, _), _ in both if kind == letter]
            times = [time for (kind, _, time), _ in both if kind == letter]
            clocks = [clock for (kind, *_), clock in both if kind == letter]
            own_sums = sums_before([(letter, size) for size in sizes], ring.zero, same_kind=True)
            yield Reading(ring, what, where, times, clocks, own_sums, sizes)


def name_of(reading: Reading, tolerance: Fraction) -> str | None:
    """Return the mistake that the times look like; None where they are right, or wrong in no known
    way."""
    ring = reading.ring
    # A part of size 0 reads nothing, so its time cannot be wrong.
    read = [k for k, size in enumerate(reading.sizes) if not size.is_zero()]

    def same(times: Sequence[Poly], others: Sequence[Poly]) -> bool:
        return all(_alike(ring, times[k] - others[k], tolerance) for k in read)

    if same(reading.times, reading.right):
        return None
    for name, clock in MISTAKES.items():
        if same(reading.times, clock(reading)):
            return name.format(what=reading.what, where=reading.where)
    return None


def _alike(ring: Ring, gap: Poly, tolerance: Fraction) -> bool:
    if tolerance == 0:
        return ring.decide(gap).zero is True
    ball = enclose_defined(ring, ring.reduce(gap), {}, _PRECISION)
    return bool(abs(ball) <= flint.fmpq(tolerance.numerator, tolerance.denominator))


def _middle_at(reading: Reading, time: int) -> list[Poly]:
    """Return the right clock, except that parts due at the middle are taken at this time."""
    ring, half = reading.ring, reading.ring.one / 2
    due = [ring.decide(clock - half).zero is True for clock in reading.right]
    return [ring.one * time if d else x for d, x in zip(due, reading.right, strict=True)]


def _own_kind_after(reading: Reading) -> list[Poly]:
    """Return the sums of the parts of its own kind up to and including each."""
    sizes = zip(reading.own_kind_sums, reading.sizes, strict=True)
    return [reading.ring.reduce(before + size) for before, size in sizes]


# The first that fits is named: of one kick, say, several may.
MISTAKES: Mapping[str, Callable[[Reading], Sequence[Poly]]] = {
    "as if the {what} were read at t in every {where}": lambda r: [r.ring.zero] * len(r.right),
    "as if the {what} were read at the step's end in every {where}": (
        lambda r: [r.ring.one] * len(r.right)
    ),
    "as if the {what} were read at the step's middle in every {where}": (
        lambda r: [r.ring.one / 2] * len(r.right)
    ),
    "the {what} in the step's middle is read at its end": lambda r: _middle_at(r, 1),
    "the {what} in the step's middle is read at its start": lambda r: _middle_at(r, 0),
    "as if each {where} read the clock of its own kind: kick and drift exchanged": lambda r: (
        r.own_kind_sums
    ),
    "as if each {where} read the clock of its own kind, after it: kick and drift exchanged": (
        _own_kind_after
    ),
    "every {where} reads the time of the one before it": lambda r: [r.ring.zero, *r.right[:-1]],
    "every {where} reads the time of the one after it": lambda r: [*r.right[1:], r.ring.one],
    "as if time ran backwards in the step": lambda r: [r.ring.one - x for x in r.right],
}
