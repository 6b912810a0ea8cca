"""The increments of p and q, with their common parts written only once.

For H = p²/2 + V(q) the Lie-derivative scheme has q' = q + h p + (h²/2) X p + (h³/6) X² p + … beside
p' = p + h X p + (h²/2) X² p + …: with a_k = h^k/(k+1)! X^k p they are p' = p + 2 a_1 + 3 a_2 + …
and q' = q + h (p + a_1 + a_2 + …). So wherever the coefficient of h^(k+1) in one of them is the one
of h^k in the other over a small integer, it is computed once. Both ways are tried, and the cheapest
is taken; where latency counts and not the number of operations, the increments stay apart.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

from verify.algebra.ring import Poly, Ring
from verify.kernels.step.program import Evaluator
from verify.schemes.maps.closed_form import h_inside

_MOST = 12  # times a value is added to itself at most
Pair = tuple[int, int]


def increments(evaluator: Evaluator, ring: Ring, pair: tuple[Poly, Poly], h: int) -> Pair:
    """Return the indices of the increments of p and q, a `pair`; `h` is the index of the step
    size."""
    ways = [_Way(ring, pair, None)]
    # Sharing saves operations but makes p' wait for q': it is not tried where latency counts.
    if not (evaluator.pipelined or h_inside(ring, *pair)):
        ways += [way for first in (0, 1) if (way := _Way(ring, pair, first)).ratios]
    return evaluator.choose_cheapest([partial(way.write, evaluator, h) for way in ways])


@dataclass
class _Way:
    """One way to write the two increments.

    `first`: the increment whose coefficients are taken from the other's; None where none are.
    """

    ring: Ring
    pair: tuple[Poly, Poly]
    first: int | None

    @cached_property
    def parts(self) -> tuple[dict[int, Poly], dict[int, Poly]]:
        """The coefficients of the first and of the second increment, by powers of h."""
        ring, (u, v) = self.ring, self.pair
        one, two = ring.powers(u, "h"), ring.powers(v, "h")
        return (one, two) if self.first == 0 else (two, one)

    @cached_property
    def ratios(self) -> dict[int, int]:
        """{k: r}: the first's coefficient of h^k is r times the second's of h^(k+1)."""
        one, two = self.parts
        if not two or min(two) < 1:
            return {}
        pairs = {k: (x, two[k + 1]) for k, x in one.items() if k >= 1 and k + 1 in two}
        ratios = ((k, r) for k, (x, y) in pairs.items() for r in range(1, _MOST) if x == r * y)
        return dict(ratios)

    def write(self, evaluator: Evaluator, h: int) -> Pair:
        program, ring = evaluator.program, self.ring
        if self.first is None:
            u, v = self.pair
            return evaluator.evaluate(u), evaluator.evaluate(v)
        (one, two), ratios = self.parts, self.ratios
        one_value = evaluator.evaluate(
            _sum(ring, {k: x for k, x in one.items() if k not in ratios})
        )
        inner = {k - 1: x for k, x in two.items() if k - 1 not in ratios}
        other_value = evaluator.evaluate(_sum(ring, inner))
        for k, times in ratios.items():
            value = evaluator.evaluate(_sum(ring, {k: two[k + 1]}))
            other_value = program.add(other_value, value)
            one_value = program.add(one_value, program.times(value, times))
        other_value = program.mul(h, other_value)
        return (one_value, other_value) if self.first == 0 else (other_value, one_value)


def _sum(ring: Ring, parts: Mapping[int, Poly]) -> Poly:
    """Return Σ h^k parts[k]."""
    h = ring.variable("h")
    return sum((h**k * x for k, x in parts.items()), ring.zero)
