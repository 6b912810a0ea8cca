"""Clocks that are wrong in a way that has a name.

The times at which kicks, drifts or stages are taken are compared with what they would be by some
mistake that is made in practice. Where all those that are read are the same, that is its name.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint

from verify.algebra.enclosure import enclosed
from verify.algebra.ring import Poly, Ring
from verify.schemes.conditions.splitting_conditions import Splitting, sums_before

_PRECISION = 192


@dataclass(frozen=True)
class Reading:
    """What is read at `times`, where `right` are the right ones: a force in kicks, say.

    `sizes`: what part of h each takes; a part of 0 reads nothing. `own`: what the parts of its own
    kind add up to before each.
    """

    ring: Ring
    what: str
    where: str
    times: Sequence[Poly]
    right: Sequence[Poly]
    own: Sequence[Poly]
    sizes: Sequence[Poly]


def mistakes_of_splitting(splitting: Splitting, within: Fraction = Fraction(0)) -> list[str]:
    """Of the kicks and, where their time counts, of the drifts: what each does, in words.

    `within`: how far two times may differ, 0 for exactly; as for clocks that were measured. Empty
    where the clocks are right, or wrong in no way that has a name.
    """
    found = (name_of(reading, within) for reading in _of_parts(splitting))
    return [name for name in found if name is not None]


def _of_parts(splitting: Splitting) -> Iterator[Reading]:
    ring, parts = splitting.numbers
    for letter, what, where in (("K", "force", "kick"), ("D", "velocity", "drift")):
        if splitting.kinetic and letter in splitting.kinetic.timed:
            both = list(zip(parts, splitting.right, strict=True))
            sizes = [size for (kind, size, _), _ in both if kind == letter]
            times = [time for (kind, _, time), _ in both if kind == letter]
            clocks = [clock for (kind, *_), clock in both if kind == letter]
            own = sums_before([(letter, size) for size in sizes], ring.zero, own=True)
            yield Reading(ring, what, where, times, clocks, own, sizes)


def name_of(reading: Reading, within: Fraction) -> str | None:
    """What mistake the times look like; None where they are right, or wrong in no way known."""
    ring = reading.ring
    read = [k for k, size in enumerate(reading.sizes) if not size.is_zero()]

    def same(times: Sequence[Poly], others: Sequence[Poly]) -> bool:
        return all(_alike(ring, times[k] - others[k], within) for k in read)

    if same(reading.times, reading.right):
        return None
    for name, clock in MISTAKES.items():
        if same(reading.times, clock(reading)):
            return name.format(what=reading.what, where=reading.where)
    return None


def _alike(ring: Ring, gap: Poly, within: Fraction) -> bool:
    if within == 0:
        return ring.decide(gap).zero is True
    ball = enclosed(ring, ring.reduce(gap), {}, _PRECISION)
    return bool(abs(ball) <= flint.fmpq(within.numerator, within.denominator))


def _middle_at(reading: Reading, time: int) -> list[Poly]:
    """The right clock, but that what is due at the middle is taken at this time."""
    ring, half = reading.ring, reading.ring.one / 2
    due = [ring.decide(clock - half).zero is True for clock in reading.right]
    return [ring.one * time if d else x for d, x in zip(due, reading.right, strict=True)]


def _own_and_itself(reading: Reading) -> list[Poly]:
    sizes = zip(reading.own, reading.sizes, strict=True)
    return [reading.ring.reduce(own + size) for own, size in sizes]


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
    "as if each {where} read the clock of its own kind: kick and drift exchanged": lambda r: r.own,
    "as if each {where} read the clock of its own kind, after it: kick and drift exchanged": (
        _own_and_itself
    ),
    "every {where} reads the time of the one before it": lambda r: [r.ring.zero, *r.right[:-1]],
    "every {where} reads the time of the one after it": lambda r: [*r.right[1:], r.ring.one],
    "as if time ran backwards in the step": lambda r: [r.ring.one - x for x in r.right],
}
