"""The times at which a traced step reads H, and the time at which each reading is due.

A reading is an operation in which what moves with p and q meets what is a function of t, as the sum
in −q³ + cos t. It is due at t + c h where what moves there has gone, to first order in h, c of the
way that the exact flow goes: so c = A 1 for the stages of a Runge–Kutta method, and for a kick what
the drifts before it add up to. It is a guess, from 600 bits at one point: whoever uses it proves
what follows from it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import gmpy2
import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import fraction
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.tracing.dual import DualNumber, Duals
from verify.integrators.tracing.linear_sums import Scalars
from verify.integrators.tracing.trace import Node, Tape, evaluate_nodes, in_order, replay_in

_POINT = {
    "p": Fraction(2, 7),
    "q": Fraction(5, 11),
    "t": Fraction(3, 13),
}  # any that is not special
_MOST_DENOMINATOR, _CLEAR = 2**64, Fraction(1, 2**150)  # of a time made of floats
_BITS, _STEP, _NO_PART = 600, Fraction(1, 2**200), Fraction(1, 2**40)


class NoReadingsError(Exception):
    """The times that are read, or are due, cannot be told."""


@dataclass(frozen=True)
class Read:
    """`time`, `due`: in parts of h after t. `size`: what part of the step it is, of that of p'
    where `of_p`, else of q'; 0 where it counts for nothing."""

    time: Fraction
    due: Fraction
    size: Fraction
    of_p: bool


@dataclass(frozen=True)
class _Place:
    """The operation that reads, which of its inputs reads, and a for each a (t + c h) in what that
    is of."""

    node: Node
    index: int
    clocks: Mapping[int, Fraction]
    time: Fraction

    @property
    def moves(self) -> Node:
        return self.node.inputs[1 - self.index]


class Readings:
    """The readings of a trace, in the order in which they are done. Raises NoReadingsError, or what
    numbers raise where it cannot be computed at a point."""

    def __init__(self, hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> None:
        self.nodes, self.roots = in_order(p_next, q_next), (p_next, q_next)
        self._scalars = Scalars(self.nodes)
        self._places = [x for node in self.nodes if (x := self._place(node)) is not None]
        self._kind = Duals()
        with gmpy2.context(precision=_BITS):
            self._point = _numbers(hamiltonian)
            due, parts = self._due(), [self._part(place) for place in self._places]
        self.reads = [
            Read(place.time, c, *part)
            for place, c, part in zip(self._places, due, parts, strict=True)
        ]

    def with_due_times(self) -> tuple[Node, Node]:
        """Return p' and q' of the same trace with each reading at the time when it is due."""
        # The trace is replayed on a fresh tape, so that the corrected step can be proved as any
        # other.
        tape = Tape()
        p, q, h, t = (tape.symbol(name) for name in "pqht")
        times = [t + h * read.due for read in self.reads]
        values = self._replay(tape, {"p": p, "q": q, "h": h, "t": t}, times)
        one, two = (values[root.number] for root in self.roots)
        return one.node, two.node

    def _place(self, node: Node) -> _Place | None:
        """Find where the node reads a time."""
        still = [k for k, x in enumerate(node.inputs) if x.number not in self._scalars.moving]
        # A reading combines one input that moves with p and q and one that does not.
        if node.number not in self._scalars.moving or len(still) != 1:
            return None
        clocks: dict[int, tuple[Fraction, Fraction]] = {}
        waiting = [node.inputs[still[0]]]
        while waiting:
            x = waiting.pop()
            clock = self._scalars.clock(x)
            if clock is not None:
                clocks[x.number] = clock
            else:
                waiting += x.inputs
        # A node that mixes several times has no single due time.
        times = {c for _, c in clocks.values()}
        if len(times) > 1:
            raise NoReadingsError
        factors = {number: a for number, (a, _) in clocks.items()}
        return _Place(node, still[0], factors, times.pop()) if times else None

    def _replay(self, kind: Any, symbols: Mapping[str, Any], times: Sequence[Any]) -> Any:
        """Evaluate all nodes in numbers of that kind, each reading at the time that `times` has for
        it."""
        plain = replay_in(kind, symbols)
        places = {
            place.node.number: (place, t) for place, t in zip(self._places, times, strict=True)
        }

        def made_of(node: Node, inputs: list[Any]) -> Any:
            if node.number in places:
                place, t = places[node.number]
                read = node.inputs[place.index]
                shifted = {number: t * factor for number, factor in place.clocks.items()}
                inner = [x for x in in_order(read) if x.number not in shifted]
                inputs = list(inputs)
                inputs[place.index] = evaluate_nodes(inner, plain, shifted)[read.number]
            return plain(node, inputs)

        return evaluate_nodes(self.nodes, made_of)

    def _due(self) -> list[Fraction]:
        """Compute the due times by derivatives along h, and along the flow in place of it, at a
        very small step."""
        kind, at = self._kind, self._point
        zero, one, h = gmpy2.mpfr(0), gmpy2.mpfr(1), kind.rational(_STEP).value
        t = DualNumber(kind, at["t"], (zero, zero))
        symbols = {
            "p": DualNumber(kind, at["p"], (zero, -at["H_q"])),
            "q": DualNumber(kind, at["q"], (zero, at["H_p"])),
            "h": DualNumber(kind, h, (one, zero)),
            "t": t,
        }
        values = self._replay(kind, symbols, [t] * len(self._places))
        due = []
        for place in self._places:
            x = values[place.moves.number]
            along_h, along_flow = x.slopes or (zero, zero)
            if not along_flow:
                raise NoReadingsError
            # It may have a power of h as a factor, as h p has: what it is without that counts.
            power = round(gmpy2.log2(abs(along_flow)) / gmpy2.log2(h))
            due.append(_rational((along_h - power * x.value / h) / along_flow))
        return due

    def _part(self, place: _Place) -> tuple[Fraction, bool]:
        """Measure a reading's part of the step by the derivatives of p' and q' along its time, at a
        very small step."""
        kind, at = self._kind, self._point
        zero, one = gmpy2.mpfr(0), gmpy2.mpfr(1)
        still = {name: DualNumber(kind, at[name], (zero,)) for name in "pqt"}
        moving_time = DualNumber(kind, at["t"], (one,))
        times = [moving_time if x is place else still["t"] for x in self._places]
        h = kind.rational(_STEP)
        values = self._replay(kind, {**still, "h": h}, times)
        slopes = [(values[root.number].slopes or (zero,))[0] / h.value for root in self.roots]
        whole = -at["H_qt"], at["H_pt"]
        parts = [
            fraction(slope / x) if x else Fraction(0)
            for slope, x in zip(slopes, whole, strict=True)
        ]
        parts = [x if abs(x) >= _NO_PART else Fraction(0) for x in parts]
        of_p = abs(parts[0]) >= abs(parts[1])
        return parts[not of_p], of_p


def _numbers(hamiltonian: Hamiltonian) -> dict[str, "gmpy2.mpfr"]:
    """Return the point, and derivatives of H at it."""
    p, q, t = (symbol(name) for name in "pqt")
    expression = hamiltonian.exact
    derivatives = {"H_p": (p,), "H_q": (q,), "H_pt": (p, t), "H_qt": (q, t)}
    point = {symbol(name): sympy.Rational(x.numerator, x.denominator) for name, x in _POINT.items()}
    numbers = {name: gmpy2.mpfr(gmpy2.mpq(x)) for name, x in _POINT.items()}
    for name, derivative in derivatives.items():
        value = sympy.N(expression.diff(*derivative).subs(point), _BITS // 3)
        if not value.is_real:
            raise NoReadingsError
        numbers[name] = gmpy2.mpfr(str(value))
    return numbers


def _rational(x: "gmpy2.mpfr") -> Fraction:
    if not gmpy2.is_finite(x):
        raise NoReadingsError
    value = fraction(x)
    near = value.limit_denominator(_MOST_DENOMINATOR)
    if abs(near - value) > _CLEAR:
        raise NoReadingsError
    return near
