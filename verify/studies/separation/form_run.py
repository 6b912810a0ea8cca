"""The float64 run of a separation in n degrees of freedom, with exact products beside it.

What `verify.studies.separation.form_kernel` carries becomes the links of W here, at every
checkpoint: W = MᵀΩM − Ω of a wide M as exact rationals, and of float64's M in float64, each entry a
sum of 2n products from the left, p's row first, and then less 1 where Ω has one.

How far they are known: what float64 made is exact. The rounding of a wide link is counted
(`verify.studies.separation.form_count`), but for a clock; where there is no such bound, it is held
against a rerun with 15 more digits, and twice the greatest difference of any entry at any
checkpoint is its bound, an estimate.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any, NamedTuple

from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.lockstep import Course
from verify.runs.estimated import digits_of
from verify.studies.separation.form_count import counted
from verify.studies.separation.form_kernel import FormKernel, form_kernel
from verify.studies.separation.mixed_run import (
    COUNTED,
    MORE_DIGITS,
    RERUN,
    Advance,
    MixedRun,
    State,
    as_rational,
)
from verify.studies.separation.trail import Trail
from verify.studies.separation.working import Link, Working, exact_link

POINTS = 512  # checkpoints of a run; each has a matrix for each link
Entries = tuple[Fraction, ...]  # of W above its diagonal, row by row
Links = tuple[Link, ...]  # one for each of these entries
_LINKS = ("w_c", "w_t", "w_n", "w_w")  # what is carried in wide numbers of which W is read


class Size(NamedTuple):
    """‖M‖² and ‖∧²M‖² in Frobenius' norm: the sum of all squares of entries, and of 2 × 2 minors.

    The second is how M changes areas, and so what a 2-form grows by: Σ σ_i² σ_j² of the singular
    values, i < j, beside the Σ σ_i² of the first.
    """

    norm: Fraction
    areas: Fraction


@dataclass(frozen=True)
class FormWorking(Working[Links]):
    """`sizes`: how large M is at every checkpoint."""

    sizes: tuple[Size, ...]


def links_of(trail: Sequence[Entries], make: Callable[[tuple[Fraction, ...]], Link]) -> Links:
    """A link for each entry, from all entries at every checkpoint."""
    return tuple(make(each) for each in zip(*trail, strict=True))


class FormRun(MixedRun[FormKernel]):
    """The float64 run of a run in n degrees of freedom."""

    points = POINTS

    def step_through(self, arithmetic: Arithmetic, advance: Advance) -> Course[FormWorking]:
        """All steps; raises Stopped where float64 leaves its range."""
        kernel = self._kernel(arithmetic)
        states = yield from self._states(kernel, arithmetic, advance)
        known = counted(kernel, arithmetic, self.inputs, states[-1], self.run.steps)
        carried = (*kernel.products, *("w_w",) * kernel.closed)
        wide = [name for name in _LINKS if name in carried]
        again: Sequence[State] = ()
        finer = number_systems.get(arithmetic.name, digits_of(arithmetic) + MORE_DIGITS)
        if any(known.get(name) is None for name in wide):
            again = yield from self._states(self._kernel(finer), finer, lambda _: None)

        def links(name: str) -> Links | None:
            if name not in wide:
                return None
            bound, trail = known.get(name), self._trail(states, name, arithmetic)
            if bound is not None:
                return links_of(
                    trail, lambda each: Link(Trail.of(each), bound, "enclosed", COUNTED)
                )
            fine = self._trail(again, name, finer)
            apart = self._apart(trail, fine, arithmetic, again, name)
            return links_of(fine, lambda each: Link(Trail.of(each), apart, "estimated", RERUN))

        factors = links("w_n")
        assert factors is not None  # noqa: S101 - every kernel has it
        plain = [tuple(map(Fraction, self._plain(state))) for state in states]
        closed = [self._entries(state, "f_w", arithmetic) for state in states if kernel.closed]
        return FormWorking(
            clock=links("w_c"),
            trajectory=links("w_t"),
            factors=factors,
            plain=links_of(plain, _of_float64),
            closed_factors=links("w_w"),
            closed_form=links_of(closed, _of_float64) if kernel.closed else None,
            sizes=tuple(self._of_size(state, arithmetic) for state in states),
        )

    def _trail(self, states: Sequence[State], name: str, own: Arithmetic) -> list[Entries]:
        """The entries of W of a wide product, or sum, at every checkpoint."""
        if name == "w_w":
            return [self._entries(state, name, own) for state in states]
        found = []
        for state in states:
            scaled, one = self._scaled(state, name, own)
            found.append(_of_whole(scaled, one))
        return found

    def _apart(
        self,
        coarse: Sequence[Entries],
        fine: Sequence[Entries],
        own: Arithmetic,
        states: Sequence[State],
        name: str,
    ) -> Fraction:
        """Twice the greatest difference of two runs, and the last bits that it may hide."""
        pairs = zip(coarse, fine, strict=True)
        apart = max(abs(x - y) for a, b in pairs for x, y in zip(a, b, strict=True))
        size = Fraction(max(abs(float(s[n])) for s in states for n in s if n[:3] == name))
        return 2 * apart + (1 + size * size) * Fraction(1, 1 << (own.bits - 4))

    @property
    def _size(self) -> int:
        return len(self.run.hamiltonian.coordinates)

    def _kernel(self, arithmetic: Arithmetic) -> FormKernel:
        return form_kernel(self.run.hamiltonian, self.run.scheme, arithmetic, self.follow)

    def _in_range(self, state: State) -> bool:
        return all(map(math.isfinite, (*self._plain(state), self._norm(state))))

    # -- what is read of a state --------------------------------------------------------------

    def _plain(self, state: State) -> tuple[float, ...]:
        """W = MᵀΩM − Ω of float64's M, in float64."""
        return of_product(lambda a, b: state[f"f_n_{a}_{b}"], self._size)

    def _norm(self, state: State) -> float:
        every = range(self._size)
        return math.hypot(*(state[f"f_n_{a}_{b}"] for a in every for b in every))

    def _of_size(self, state: State, own: Arithmetic) -> Size:
        return size_of(*self._scaled(state, "w_n", own))

    def _scaled(self, state: State, matrix: str, own: Arithmetic) -> tuple[list[list[int]], int]:
        """A wide matrix as whole numbers over one denominator: Fractions take ten times as long."""
        every = range(self._size)
        exact = [[as_rational(state[f"{matrix}_{a}_{b}"], own) for b in every] for a in every]
        one = max(x.denominator for row in exact for x in row)  # of powers of 2
        return [[x.numerator * (one // x.denominator) for x in row] for row in exact], one

    def _entries(self, state: State, matrix: str, own: Arithmetic) -> Entries:
        places = combinations(range(self._size), 2)
        return tuple(as_rational(state[f"{matrix}_{a}_{b}"], own) for a, b in places)


def of_product(entry: Callable[[int, int], Any], size: int, one: int = 1) -> tuple[Any, ...]:
    """The entries of MᵀΩM − Ω above the diagonal, row by row, in the arithmetic of M's entries; or
    times `one`, of an M that is times its root."""
    n, found = size // 2, []
    for a, b in combinations(range(size), 2):
        total = entry(0, a) * entry(n, b) - entry(n, a) * entry(0, b)
        for i in range(1, n):
            total = total + entry(i, a) * entry(n + i, b)
            total = total - entry(n + i, a) * entry(i, b)
        found.append(total - one if b == n + a else total)
    return tuple(found)


def _of_whole(matrix: Sequence[Sequence[int]], one: int) -> Entries:
    """MᵀΩM − Ω of M = `matrix`/`one`."""
    found = of_product(lambda a, b: matrix[a][b], len(matrix), one * one)
    return tuple(Fraction(x, one * one) for x in found)


def size_of(matrix: Sequence[Sequence[int]], one: int) -> Size:
    """The sizes of `matrix`/`one`: ‖∧²M‖² = (‖M‖⁴ − ‖MᵀM‖²)/2."""
    columns, every = list(zip(*matrix, strict=True)), range(len(matrix))
    square = {
        (a, b): sum(x * y for x, y in zip(columns[a], columns[b], strict=True))
        for a in every
        for b in range(a, len(matrix))
    }
    norm = sum(square[a, a] for a in every)
    whole = sum((1 if a == b else 2) * x * x for (a, b), x in square.items())
    return Size(Fraction(norm, one**2), Fraction(norm * norm - whole, 2 * one**4))


def _of_float64(trail: tuple[Fraction, ...]) -> Link:
    return exact_link(trail, "a float64")
