"""Order of a splitting for H = T(p, t) + V(q, t), by conditions on its parts and their times.

The step's coefficient of each word in the letters K_n and D_n
(`verify.schemes.conditions.words.words`) is to be that of the exact flow. A product of exponentials
of letters is group-like, so that where all coefficients of weights below n agree, the difference at
weight n is a Lie polynomial: those of Lyndon words suffice, 2, 2, 4, 7, 15, 28, 62, 126 of weights
1 … 8 where T depends on p alone, and 2, 3, 6, 12, 28, 61, 148, 345 where it depends on t. They are
needed: the Hamiltonians of brackets of letters, K_n standing for any V_n(q) and D_n for any T_n(p),
are independent in the plane up to weight 8 (a test has their rank). Without letters of n > 0 these
are the conditions of `verify.schemes.conditions.splitting_conditions`; and where the clocks are
right they are all that is asked (below).

For quadratic T brackets vanish or are equal from weight 4 on. There the conditions are those
combinations of coefficients in the generator of the step
(`verify.schemes.conditions.words.step_words`) that count
(`verify.schemes.conditions.words.quadratic`): 2, 2, 4, 6, 12, 20, 39, 67 for p²/(2m), and 2, 3, 6,
11, 23, 45, 93, 182 for p²/(2m(t)).

The time at which each part of a splitting reads its force or its velocity.

The right clock of a kick is advanced by the drifts, that of a drift by the kicks: a kick reads the
force at t + h·(drifts before it), a drift the velocity at t + h·(kicks before it). For then the
step is that of a splitting without time. With times x and y as further coordinates and X, Y their
momenta, H = T(p, y) + X + V(q, x) + Y is a sum of A = V(q, x) + Y, whose flow is the kick and
advances y, and of B = T(p, y) + X, whose flow is the drift and advances x. After the canonical
change (y, Y) → (Y, −y) A is a function of coordinates and B one of momenta. The conditions for
T(p) + V(q) hold in any number of degrees of freedom; so with right clocks every splitting keeps
its order for every H = T(p, t) + V(q, t). Nyström methods, which have theirs for quadratic T alone,
do not where T depends on t: that B is not quadratic in the momenta.

Where the drifts do not add up to 1, the kicks' clock does not reach the step's end. That is no
fault of the clock: the condition Σ drifts = 1 fails, of order 1.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import ClassVar

import sympy

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.schemes.conditions.condition import Condition
from verify.schemes.conditions.splitting_conditions import (
    LETTERS,
    MOST_ORDER,
    Nearby,
    Part,
    Splitting,
    WordConditions,
)
from verify.schemes.conditions.words.equations import equations_of
from verify.schemes.conditions.words.kinetic import Kinetic
from verify.schemes.conditions.words.step_words import StepWords, TimedPart

Times = tuple[sympy.Expr | None, ...]  # of the parts, as parts of h; None where it is the right one


def right_clocks(ring: Ring, parts: Sequence[tuple[str, Poly]]) -> list[Poly]:
    """The times that keep the order, of letters K and D with sizes: for each part the sum of the
    other kind's before it."""
    clocks, found = {"K": ring.zero, "D": ring.zero}, []
    for kind, size in parts:
        found.append(clocks[kind])
        other = "D" if kind == "K" else "K"
        clocks[other] = ring.reduce(clocks[other] + size)
    return found


@dataclass(frozen=True)
class TimedSplitting:
    """Kicks p − a h V_q(q, t + s h) and drifts q + a h T_p(p, t + s h), for every V and every T of
    a class.

    `times`: s of each part, None for the right one; ValueError unless there are as many as parts.
    `nearby`: of sizes or times that are printed decimals, the order that exact ones near them have.
    It is a `verify.schemes.conditions.condition.ByConditions`.
    """

    parts: tuple[Part, ...]
    times: Times
    kinetic: Kinetic = Kinetic.GENERAL
    nearby: Nearby | None = field(default=None, compare=False, repr=False)
    separable: ClassVar[bool] = True
    most_order: ClassVar[int] = MOST_ORDER

    def __post_init__(self) -> None:
        if len(self.parts) != len(self.times):
            raise ValueError(f"{len(self.times)} times of {len(self.parts)} parts")

    @classmethod
    def of(cls, splitting: Splitting, kinetic: Kinetic = Kinetic.GENERAL) -> "TimedSplitting":
        """The same parts at their right times."""
        return cls(splitting.parts, (None,) * len(splitting.parts), kinetic)

    @cached_property
    def plain(self) -> Splitting:
        """The same parts without time."""
        return Splitting(self.parts)

    @cached_property
    def numbers(self) -> tuple[Ring, list[TimedPart]]:
        """The parts, letters with sizes and times in one ring."""
        told = [time for time in self.times if time is not None]
        ring, numbers = embed([*(size for _, size in self.parts), *told], ())
        sizes, rest = numbers[: len(self.parts)], iter(numbers[len(self.parts) :])
        kinds = [LETTERS[kind] for kind, _ in self.parts]
        right = right_clocks(ring, list(zip(kinds, sizes, strict=True)))
        times = [x if t is None else next(rest) for x, t in zip(right, self.times, strict=True)]
        return ring, list(zip(kinds, sizes, times, strict=True))

    @cached_property
    def clocks_are_right(self) -> bool:
        """Whether each part that reads a time has the right one, exactly; one of size 0 reads
        none."""
        ring, parts = self.numbers
        return all(
            kind not in self.kinetic.timed
            or size.is_zero()
            or ring.decide(time - clock).zero is True
            for (kind, size, time), clock in zip(parts, self.right, strict=True)
        )

    @property
    def clock(self) -> list[sympy.Expr]:
        """The time of each part, in parts of h."""
        ring, parts = self.numbers
        return [ring.expression(time) for _, _, time in parts]

    @cached_property
    def right(self) -> list[Poly]:
        """The right time of each part, in the ring of `numbers`."""
        ring, parts = self.numbers
        return right_clocks(ring, [(kind, size) for kind, size, _ in parts])

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Those of weights 1 … `order`; InputError beyond order 8."""
        if self.clocks_are_right and not self.kinetic.quadratic:
            return self.plain.order_conditions(order)
        return self._conditions.up_to(order)

    def area_conditions(self) -> tuple[Condition, ...]:
        """At a fixed time a kick and a drift are shears: those of the same parts without time."""
        return self.plain.area_conditions()

    @cached_property
    def _conditions(self) -> WordConditions:
        ring, parts = self.numbers
        return WordConditions(ring, StepWords(ring, parts), partial(equations_of, self.kinetic))
