"""The times at which a traced step reads H, and the time at which each reading is due.

A reading is an operation with one input that depends on p or q and one that is a function of t, as
the sum in −q³ + cos t. It is due at t + c h if the first input, to first order in h, has the value
that the exact flow gives it at t + c h: for the stages of a Runge–Kutta method c = A 1, and for a
kick c is the sum of the drifts before it. The times are guesses, from 600 bits at one point:
whoever uses them has to prove the result.
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
}  # any point will do that is not special
# A time in units of h, a sum of floats, is a rational with this denominator up to the tolerance.
_MAX_DENOMINATOR, _RATIONAL_TOLERANCE = 2**64, Fraction(1, 2**150)
_BITS, _STEP = 600, Fraction(1, 2**200)
_MIN_PART = Fraction(1, 2**40)  # a reading with a smaller part of the step counts for nothing


class NoReadingsError(Exception):
    """The times that are read, or are due, cannot be determined."""


@dataclass(frozen=True)
class Read:
    """The time at which H is read, and the time that is due, both in units of h after t.

    `size`: the weight of the reading in the step of p' if `of_p`, and of q' otherwise; 0 if it is
    negligible.
    """

    time: Fraction
    due: Fraction
    size: Fraction
    of_p: bool


@dataclass(frozen=True)
class _Reading:
    """The operation `node`, whose input at `index` is a function of t.

    `clocks`: the factor a of each node a (t + c h) in this input; `time`: their common c.
    """

    node: Node
    index: int
    clocks: Mapping[int, Fraction]
    time: Fraction

    @property
    def moves(self) -> Node:
        """The input that depends on p or q."""
        return self.node.inputs[1 - self.index]


class Readings:
    """The readings of a trace in their order.

    Raises NoReadingsError, or an arithmetic error if the trace is undefined at the point.
    """

    def __init__(self, hamiltonian: Hamiltonian, p_next: Node, q_next: Node) -> None:
        self.nodes, self.roots = in_order(p_next, q_next), (p_next, q_next)
        self._scalars = Scalars(self.nodes)
        self._readings = [x for node in self.nodes if (x := self._find_reading(node)) is not None]
        self._kind = Duals()
        with gmpy2.context(precision=_BITS):
            self._point = _values_at_point(hamiltonian)
            due, parts = (
                self._find_due_times(),
                [self._measure_part(reading) for reading in self._readings],
            )
        self.reads = [
            Read(reading.time, c, *part)
            for reading, c, part in zip(self._readings, due, parts, strict=True)
        ]

    def with_due_times(self) -> tuple[Node, Node]:
        """Return p' and q' of the same trace with each reading at the time when it is due."""
        # The trace is replayed on a new tape, so that the corrected step can be proved like any
        # other.
        tape = Tape()
        p, q, h, t = (tape.symbol(name) for name in "pqht")
        times = [t + h * read.due for read in self.reads]
        values = self._replay(tape, {"p": p, "q": q, "h": h, "t": t}, times)
        one, two = (values[root.number] for root in self.roots)
        return one.node, two.node

    def _find_reading(self, node: Node) -> _Reading | None:
        """Return the reading of a node; None if it reads no time. Raises NoReadingsError if it
        reads several times at once."""
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
        return _Reading(node, still[0], factors, times.pop()) if times else None

    def _replay(self, kind: Any, symbols: Mapping[str, Any], times: Sequence[Any]) -> Any:
        """Evaluate all nodes in numbers of that kind, each reading at the time that `times` has for
        it."""
        plain = replay_in(kind, symbols)
        readings = {
            reading.node.number: (reading, t)
            for reading, t in zip(self._readings, times, strict=True)
        }

        def made_of(node: Node, inputs: list[Any]) -> Any:
            if node.number in readings:
                reading, t = readings[node.number]
                read = node.inputs[reading.index]
                shifted = {number: t * factor for number, factor in reading.clocks.items()}
                inner = [x for x in in_order(read) if x.number not in shifted]
                inputs = list(inputs)
                inputs[reading.index] = evaluate_nodes(inner, plain, shifted)[read.number]
            return plain(node, inputs)

        return evaluate_nodes(self.nodes, made_of)

    def _find_due_times(self) -> list[Fraction]:
        """Compute the due times, in units of h after t, at a very small step.

        c is the derivative of the input by h, divided by its derivative along the flow.
        """
        kind, at = self._kind, self._point
        zero, one, h = gmpy2.mpfr(0), gmpy2.mpfr(1), kind.rational(_STEP).value
        t = DualNumber(kind, at["t"], (zero, zero))
        symbols = {
            "p": DualNumber(kind, at["p"], (zero, -at["H_q"])),
            "q": DualNumber(kind, at["q"], (zero, at["H_p"])),
            "h": DualNumber(kind, h, (one, zero)),
            "t": t,
        }
        values = self._replay(kind, symbols, [t] * len(self._readings))
        due = []
        for reading in self._readings:
            x = values[reading.moves.number]
            along_h, along_flow = x.slopes or (zero, zero)
            if not along_flow:
                raise NoReadingsError
            # A factor h^power, as in h p, is divided out: its derivative by h is subtracted.
            power = round(gmpy2.log2(abs(along_flow)) / gmpy2.log2(h))
            due.append(_rational((along_h - power * x.value / h) / along_flow))
        return due

    def _measure_part(self, reading: _Reading) -> tuple[Fraction, bool]:
        """Return the weight of a reading, and True if it is in p'.

        It is the derivative of p' or q' by the time of this reading alone, at a very small step,
        relative to that of the exact flow.
        """
        kind, at = self._kind, self._point
        zero, one = gmpy2.mpfr(0), gmpy2.mpfr(1)
        still = {name: DualNumber(kind, at[name], (zero,)) for name in "pqt"}
        moving_time = DualNumber(kind, at["t"], (one,))
        times = [moving_time if x is reading else still["t"] for x in self._readings]
        h = kind.rational(_STEP)
        values = self._replay(kind, {**still, "h": h}, times)
        slopes = [(values[root.number].slopes or (zero,))[0] / h.value for root in self.roots]
        whole = -at["H_qt"], at["H_pt"]
        parts = [
            fraction(slope / x) if x else Fraction(0)
            for slope, x in zip(slopes, whole, strict=True)
        ]
        parts = [x if abs(x) >= _MIN_PART else Fraction(0) for x in parts]
        of_p = abs(parts[0]) >= abs(parts[1])
        return parts[not of_p], of_p


def _values_at_point(hamiltonian: Hamiltonian) -> dict[str, "gmpy2.mpfr"]:
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
    near = value.limit_denominator(_MAX_DENOMINATOR)
    if abs(near - value) > _RATIONAL_TOLERANCE:
        raise NoReadingsError
    return near
