"""How far an orbit may go in a fixed-point format: limits within which nothing can overflow.

Interval arithmetic over the box |p| < reach_p, |q| < reach_q bounds every operation of a step, with
functions' values taken to stay below reach_value. A large box of rounded sides for which all of
them stay in the format is found before the run; the kernel ends the loop where the orbit leaves it,
or a function's value its limit. So an overflow is not looked for at every operation, and cannot
happen.
"""

from bisect import bisect_right
from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache, partial
from itertools import product
from typing import NamedTuple

import flint

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.coordinates import PLANE
from verify.kernels.kernel import Kernel
from verify.kernels.rounding import PRECISION, Ball, Rounded, analyse
from verify.kernels.turns import Times

_TOP = Fraction(2) ** 15 * (1 - Fraction(1, 2**20))  # numbers are below 2^15 in size
_MATRIX_LIMITS = tuple(Fraction(2) ** n for n in (12, 10, 8, 6, 4, 3, 2))
_VALUE_LIMITS = tuple(Fraction(2) ** n for n in (13, 11, 9, 7, 5, 4, 3, 2, 1))
_SIDES = tuple(
    Fraction(2) ** n * share * Fraction(1023, 1024)
    for n in range(15, -8, -1)
    for share in (1, Fraction(3, 4))
)
_ASCENDING = _SIDES[::-1]


class Limits(NamedTuple):
    """What all momenta, all coordinates, Λ (or 1 + Λ), functions' values, and M's entries where it
    is carried, stay below; see `kernel.LIMITS`."""

    p: Fraction
    q: Fraction
    part: Fraction
    value: Fraction
    matrix: Fraction


def limits(
    kernel: Kernel,
    inputs: Mapping[str, Fraction],
    start: Mapping[str, Fraction],
    times: Times | None = None,
) -> Limits | None:
    """The kernel's limits for these h and parameters, by the names that its source has for them.

    `times`: the first and the last, where H depends on time. None where no box that holds the start
    is safe.
    """
    sizes = {name: abs(start[name]) for name in kernel.coordinates}
    own = [max(x for name, x in sizes.items() if name[0] == kind) for kind in PLANE]
    roomy = [[room * max(own)] * 2 for room in (16, 2)]
    boxes = tuple((_side(p), _side(q)) for p, q in (*roomy, own))
    return _largest(kernel, tuple(inputs.items()), times, boxes)


def _side(size: Fraction) -> Fraction | None:
    """The least side beyond a size."""
    at = bisect_right(_ASCENDING, size)
    return _ASCENDING[at] if at < len(_ASCENDING) else None


# Of a grid's starts most lie in the same few boxes.
@lru_cache(maxsize=1 << 12)
def _largest(
    kernel: Kernel,
    inputs: tuple[tuple[str, Fraction], ...],
    times: Times | None,
    boxes: tuple[tuple[Fraction | None, Fraction | None], ...],
) -> Limits | None:
    """The limits of the first of the boxes that is safe, with the greatest limit of values, grown
    as far as can be."""

    def grown(p: Fraction, q: Fraction, value: Fraction, matrix: Fraction) -> Limits:
        """First to all sides."""
        safe = partial(_room, kernel, inputs, times, matrix)
        wider = ((max(p, r), max(q, r)) for r in _SIDES)
        p, q = next((p, q) for p, q in wider if safe(p, q, value) is not None)
        # q first: it is an angle more often than p, and grows where that turns.
        q = next(r for r in _SIDES if r == q or safe(p, r, value) is not None)
        p = next(r for r in _SIDES if r == p or safe(r, q, value) is not None)
        part = safe(p, q, value)
        assert part is not None  # noqa: S101 - as was just seen
        return Limits(p, q, part, value, matrix)

    matrices = _MATRIX_LIMITS if kernel.matrix else (Fraction(1),)
    with working_precision(PRECISION):
        for (p, q), value, matrix in product(boxes, _VALUE_LIMITS, matrices):
            if p and q and _room(kernel, inputs, times, matrix, p, q, value) is not None:
                return grown(p, q, value, matrix)
    return None


@lru_cache(maxsize=1 << 14)
def _room(
    kernel: Kernel,
    inputs: tuple[tuple[str, Fraction], ...],
    times: Times | None,
    matrix: Fraction,
    p: Fraction,
    q: Fraction,
    value: Fraction,
) -> Fraction | None:
    """How large Λ may become; None where an operation may leave the format in this box, M's entries
    staying below `matrix`.

    Boxes have few sides, so that the runs of a grid ask for the same ones.
    """
    given = {name: Rounded(rational_ball(x), flint.arb(0)) for name, x in inputs}
    around = flint.arb(0, 1)
    own = {name: p if name[0] == "p" else q for name in kernel.coordinates}
    own |= dict.fromkeys(kernel.matrix, matrix)
    given |= {n: Rounded(rational_ball(r) * around, flint.arb(0)) for n, r in own.items()}
    if times:
        first, last = map(rational_ball, times)
        given["t"] = Rounded(first.union(last), flint.arb(0))
    program, live = kernel.lowering.program, kernel.lowering.live(kernel.roots)
    found = analyse(program, live, given, lambda *_: flint.arb(0), rational_ball(value))
    if found is None:
        return None
    sizes = [x.magnitude for x in (*found.values(), *([given["t"]] if times else []))]
    size = {name: found[index].magnitude for name, index in kernel.outputs.items()}
    sizes += [rational_ball(r) + size[f"d{name}"] for name, r in own.items()]
    sizes.append(size["dj"] * size["dj"])
    top = rational_ball(_TOP)
    return _part_limit(size) if all(x < top for x in sizes) else None


def _part_limit(size: Mapping[str, Ball]) -> Fraction | None:
    """The power of two that Λ, and the plain product of determinants, may reach: D (1 + Λ),
    Λ + D (1 + Λ) and the next product stay below 2^15."""
    determinant = size.get("det", flint.arb(0))
    for n in range(13, -1, -1):
        if size["dj"] * (1 + 2**n) < 2**14 and determinant * 2**n < 2**14:
            return Fraction(2**n)
    return None
