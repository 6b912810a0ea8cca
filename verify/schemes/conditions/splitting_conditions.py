"""Order and area of a splitting, by conditions on its parts and their times, evaluated exactly.

With K and D the Lie derivatives of kick and drift, the step is S = exp(k₁hK) exp(d₁hD) …, in the
order in which the parts are applied, and the exact flow is exp(h(K + D)). Both are power series in
two letters that do not commute. The flow's coefficient of every word of n letters is 1/n!. If the
step has the same coefficients up to n letters, the map agrees with the flow up to hⁿ, for every H =
T(p) + V(q).

Not every word is needed. A product of exponentials of letters is group-like: the product of the
coefficients of two words is the sum of those of their shuffles (Ree). In the shuffle algebra every
word is a polynomial in Lyndon words, which are smaller than each of their proper ends (Radford, J.
Algebra 58 (1979); Reutenauer, Free Lie Algebras, 1993, Theorem 6.1). So if the coefficients of the
Lyndon words up to n letters are right, all are: 2, 1, 2, 3, 6, 9, 18, 30 conditions of order 1 … 8
(compare Hairer, Lubich, Wanner, Geometric Numerical Integration, III.5).

All of them are needed. If the coefficients of fewer than n letters are right, the difference at n
letters is a Lie polynomial, which vanishes exactly if its coefficients of the Lyndon words do
(Reutenauer, Theorem 5.1). In the plane its K and D are Poisson brackets with V(q) and T(p). The
brackets of n letters are independent over all V and T up to n = 8 (a test computes their rank; the
56 with nine letters have rank 54), so that for some H the map differs from the flow.

For H = T(p, t) + V(q, t) there are letters K_n and D_n (`verify.schemes.conditions.words.words`);
without those of n > 0 the conditions are the ones above. By the same argument Lyndon words suffice:
2, 2, 4, 7, 15, 28, 62, 126 of weights 1 … 8 if T depends on p alone, and 2, 3, 6, 12, 28, 61, 148,
345 if it depends on t. All are needed: the Hamiltonians of brackets of letters, where K_n is any
V_n(q) and D_n any T_n(p), are independent in the plane up to weight 8 (a test computes their rank).

For quadratic T some brackets vanish or are equal from weight 4 on. There the conditions are
combinations of coefficients in the generator of the step
(`verify.schemes.conditions.words.step_words`); `verify.schemes.conditions.words.equations` derives
which. There are 2, 2, 4, 6, 12, 20, 39, 67 of them for p²/(2m), and 2, 3, 6, 11, 23, 45, 93, 182
for p²/(2m(t)).

Each part reads its force, or its velocity, at a time. The right clock of a kick is advanced by the
drifts, that of a drift by the kicks: a kick reads the force at t + h·(drifts before it), a drift
the velocity at t + h·(kicks before it). With these clocks the step is that of a splitting without
time. Take times x and y as further coordinates and X, Y as their momenta: H = T(p, y) + X + V(q, x)
+ Y is a sum of A = V(q, x) + Y, whose flow is the kick and advances y, and of B = T(p, y) + X,
whose flow is the drift and advances x. After the canonical change (y, Y) → (Y, −y) A is a function
of coordinates and B one of momenta. The conditions for T(p) + V(q) hold in any number of degrees of
freedom; so with right clocks every splitting keeps its order for every H = T(p, t) + V(q, t).
Nyström methods, which have their order for quadratic T alone, do not keep it if T depends on t: B
is then not quadratic in the momenta.

If the drifts do not add up to 1, the kicks' clock does not reach the step's end. That is no fault
of the clock: the condition Σ drifts = 1, of order 1, fails.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import ClassVar, TypeAlias

import flint

from verify.algebra.embedding import embed
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.number_system import E
from verify.errors import InputError
from verify.lazy_sympy import sympy
from verify.prose import count
from verify.schemes.conditions.condition import Condition, NearbyOrder, condition_of
from verify.schemes.conditions.every_hamiltonian import StageEquations
from verify.schemes.conditions.words.equations import equations_of_weight, residuals_of
from verify.schemes.conditions.words.step_words import StepWords, TimedPart
from verify.schemes.conditions.words.words import Kinetic

# "kick" or "drift", and its size in parts of h. A rational size may be a Fraction: a scheme with
# these alone is made without sympy.
Part: TypeAlias = "tuple[str, sympy.Expr | Fraction]"
Parts: TypeAlias = "tuple[tuple[str, sympy.Expr], ...]"
Times: TypeAlias = "tuple[sympy.Expr | None, ...]"  # in parts of h; None for the right time
Nearby: TypeAlias = Callable[[int], NearbyOrder | None]  # takes the highest order to test
MOST_ORDER = 8  # not all conditions of higher orders are needed in the plane
LETTERS = {"kick": "K", "drift": "D"}
_RESIDUAL_DIGITS = 12


def sums_before(parts: Sequence[tuple[str, E]], zero: E, *, same_kind: bool = False) -> list[E]:
    """Return for each part the sum of the earlier parts of the other kind, or of the same kind.

    The sums of the other kind are the right times.

    >>> sums_before([("kick", 1), ("drift", 2), ("kick", 1)], 0)
    [0, 1, 2]
    """
    # A drift advances the clock that kicks read, and a kick the one that drifts read.
    sums: dict[str, E] = {}
    totals = []
    for kind, size in parts:
        read = (x for other, x in sums.items() if (other == kind) is same_kind)
        totals.append(sum(read, zero))
        sums[kind] = sums.get(kind, zero) + size
    return totals


@dataclass(frozen=True)
class Splitting:
    """Kicks p − a h V'(q) and drifts q + a h T'(p) of these parts of h, for H = T(p) + V(q).

    Sizes are rational or algebraic numbers: `parts` has them as expressions. `times`: for an H that
    depends on time, the time of each part in parts of h from the step's start, None for the right
    one; if empty, all are right. `kinetic`: the class of T in H = T + V(q, t) that conditions are
    for; None for H without time. `nearby`: if sizes are printed decimals, a function for the order
    of exact sizes near them; `nearby_in_time`: the same if sizes or `times` are printed decimals.
    ValueError unless there are as many times as parts. It is a
    `verify.schemes.conditions.condition.ByConditions`.
    """

    raw_parts: tuple[Part, ...]
    times: Times = ()
    kinetic: Kinetic | None = None
    nearby: Nearby | None = field(default=None, compare=False, repr=False)
    nearby_in_time: Nearby | None = field(default=None, compare=False, repr=False)
    separable: ClassVar[bool] = True
    kind: ClassVar[str] = "splittings"  # the file of `verify.schemes.maps.kinds`
    most_order: ClassVar[int] = MOST_ORDER  # the highest of which there are conditions

    def __post_init__(self) -> None:
        if self.times and len(self.raw_parts) != len(self.times):
            raise ValueError(f"{len(self.times)} times of {len(self.raw_parts)} parts")

    def in_time(self, kinetic: Kinetic | None = None, times: Times = ()) -> Splitting:
        """Return the splitting for H = T + V(q, t), T of a class, with these times or its own."""
        clock_times = tuple(times) or self.times
        near = self.nearby_in_time if clock_times == self.times else None
        if all(time is None for time in clock_times):
            near = self.nearby
        return replace(self, times=clock_times, kinetic=kinetic or Kinetic.GENERAL, nearby=near)

    @cached_property
    def parts(self) -> Parts:
        """The parts, each with its size as an expression."""
        return tuple((kind, sympy.sympify(size)) for kind, size in self.raw_parts)

    @property
    def all_times(self) -> tuple[sympy.Expr, ...]:
        """The time of each part: the specified one, else the right one."""
        right = sums_before(self.parts, sympy.S.Zero)
        clock_times = self.times or (None,) * len(right)
        return tuple(x if t is None else t for x, t in zip(right, clock_times, strict=True))

    @property
    def evaluations(self) -> dict[str, int]:
        """The evaluations of H_p and of H_q in a step."""
        kinds = Counter(kind for kind, _ in self.raw_parts)
        return {"H_p": kinds["drift"], "H_q": kinds["kick"]}

    @property
    def a_step(self) -> str:
        """The cost of a step, in words."""
        counts = self.evaluations
        return f"{count(counts['H_q'], 'kick')}, {count(counts['H_p'], 'drift')}"

    @cached_property
    def numbers(self) -> tuple[Ring, list[TimedPart]]:
        """The parts as letters, with sizes and times in one ring; by default the right times."""
        times = self.times if self.kinetic else ()
        clock_times = [time for time in times if time is not None]
        ring, numbers = embed([*(size for _, size in self.parts), *clock_times], ())
        remaining = iter(numbers)
        sized_parts = [(LETTERS[kind], next(remaining)) for kind, _ in self.parts]
        right = sums_before(sized_parts, ring.zero)
        chosen_times = times or (None,) * len(right)
        clock = [
            x if t is None else next(remaining) for x, t in zip(right, chosen_times, strict=True)
        ]
        return ring, [(*part, time) for part, time in zip(sized_parts, clock, strict=True)]

    @cached_property
    def right(self) -> list[Poly]:
        """The right time of each part, in the ring of `numbers`."""
        ring, parts = self.numbers
        return sums_before([(letter, size) for letter, size, _ in parts], ring.zero)

    @cached_property
    def clocks_are_right(self) -> bool:
        """True if every part that reads a time has exactly the right one; size 0 reads none."""
        ring, parts = self.numbers
        return all(
            (self.kinetic is not None and letter not in self.kinetic.timed_letters)
            or size.is_zero()
            or ring.decide(time - clock).zero is True
            for (letter, size, time), clock in zip(parts, self.right, strict=True)
        )

    @property
    def clock(self) -> list[sympy.Expr]:
        """The time of each part, in parts of h."""
        ring, parts = self.numbers
        return [ring.expression(time) for _, _, time in parts]

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        """Return the conditions of weights 1 … `order`, each on a Lyndon word or a combination.

        Raises InputError beyond order 8.
        """
        if order > MOST_ORDER:
            raise InputError("order", order, f"of a splitting is proved up to {MOST_ORDER}")
        return tuple(c for n in range(1, order + 1) for c in self._of_weight(n))

    def _of_weight(self, n: int) -> tuple[Condition, ...]:
        if n not in self._conditions_by_weight:
            equations, (ring, _) = equations_of_weight(self._condition_class, n), self.numbers
            residuals = residuals_of(equations, self.words)
            self._conditions_by_weight[n] = tuple(
                condition_of(ring, equation.name, n, residual, _RESIDUAL_DIGITS)
                for equation, residual in zip(equations, residuals, strict=True)
            )
        return self._conditions_by_weight[n]

    @cached_property
    def _conditions_by_weight(self) -> dict[int, tuple[Condition, ...]]:
        return {}

    @cached_property
    def _condition_class(self) -> Kinetic | None:
        """The class of T whose conditions are used; None for those without time."""
        # With right clocks those without time suffice, except for quadratic T: see the module's
        # text.
        any_t = self.kinetic is not None and not self.kinetic.quadratic
        return None if any_t and self.clocks_are_right else self.kinetic

    @cached_property
    def words(self) -> StepWords:
        """The step's coefficients of words."""
        return StepWords(*self.numbers)

    def area_conditions(self) -> tuple[Condition, ...]:
        """Return the conditions that every kick and every drift has determinant 1.

        They hold for every size, T and V, at a fixed time.
        """
        context = flint.fmpq_mpoly_ctx.get(("x",), flint.Ordering.lex)
        (x,), one, zero = context.gens(), context.constant(1), context.constant(0)
        # x stands for a h V'' or a h T'', which may be any number.
        shears = {"kick": ((one, -x), (zero, one)), "drift": ((one, zero), (x, one))}
        kinds = dict.fromkeys(kind for kind, _ in self.parts)
        conditions = []
        for kind in kinds:
            (a, b), (c, d) = shears[kind]
            residual = a * d - b * c - 1
            conditions.append(
                Condition(f"det of every {kind} = 1", 0, str(residual), bool(residual == zero))
            )
        return tuple(conditions)

    @property
    def stages(self) -> StageEquations | None:
        """The same scheme as `StageEquations`; None if a coefficient is irrational."""
        if all(size.is_Rational for _, size in self.parts):
            return StageEquations.from_shears(self.parts)
        return None
