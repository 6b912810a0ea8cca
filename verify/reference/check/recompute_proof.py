"""What is proved of a scheme, looked at again: powers of h in det J and in the map, at some points.

The step is done with power series in h for p, q and the Jacobian: their coefficients are balls.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

import flint

from verify.reference.check.difference import Place
from verify.reference.check.taylor import Expansion, Number, number
from verify.reference.check.textbook import Field, Step, flow_series, step_of
from verify.reference.make.models import Data, Proof

MOST_ORDER = 12  # to which a map is looked at that agrees with another
ANY_ORDER = 100  # beyond which no proof goes
BITS = 512


def proof_again(known: Field, data: Data, proof: Proof, file: Place) -> None:
    """The powers of h in det J and in the map, at points near the initial values.

    That a coefficient vanishes for every p and q is not seen so, but that it does not is.
    """
    order, convergence = proof.order, proof.convergence_order
    row = file.at(f"proof of {proof.scheme}")
    for column, given in (("order", order), ("convergence_order", convergence)):
        if (given or 0) > ANY_ORDER:
            row.differs(column, f"at most {ANY_ORDER}", str(given))
            return
    most = max(MOST_ORDER if order is None else order, (convergence or 0) + 1)
    looking = _Looking(known, proof, row, most)
    for p, q, t in _points(data):
        with flint.ctx.workprec(BITS), length_of_series(most + 1):
            looking.at(p, q, t)
    looking.end()


class _Looking:
    """One proof's coefficients at one point after another."""

    def __init__(self, known: Field, proof: Proof, row: Place, most: int) -> None:
        self.known, self.proof, self.row, self.most = known, proof, row, most
        self.step, self.leading = step_of(proof.scheme, known), known.tape.read(proof.leading)
        self.looked, self.seen = 0, {"order": False, "convergence_order": False}

    def at(self, *point: Fraction) -> None:
        area, apart, lead = _powers(self.known, self.step, point, self.most, self.leading)
        if not all(x.is_finite() for x in (*area, *apart, lead)):
            return
        self.looked += 1
        order, convergence = self.proof.order, self.proof.convergence_order
        self._vanish("order", area[: self.most + 1 if order is None else order])
        upto = self.most - 1 if convergence is None else convergence
        self._vanish("convergence_order", apart[: upto + 1])
        if order is not None:
            wanted = f"{shown(area[order], 20)} at a point"
            self.row.must((area[order] - lead).contains(0), "leading", wanted, shown(lead, 20))
            self.seen["order"] |= not area[order].contains(0)
        if convergence is not None:
            self.seen["convergence_order"] |= not apart[convergence + 1].contains(0)

    def _vanish(self, column: str, coefficients: list[Number]) -> None:
        for k, c in enumerate(coefficients):
            if not c.contains(0):
                least = k if column == "order" else k - 1
                wanted = f"{least}, since the coefficient of h^{k} is {shown(c, 12)}"
                self.row.differs(column, wanted, str(getattr(self.proof, column)))
                return

    def end(self) -> None:
        """What was claimed not to vanish, and did wherever it was looked at."""
        if not self.looked:
            self.row.is_left_out("H is not defined nearby")
            return
        self.row.findings.recomputed += 1
        for column, seen in self.seen.items():
            given = getattr(self.proof, column)
            wanted = "more, since that coefficient is 0"
            self.row.must(seen or given is None, column, wanted, str(given))


def _powers(
    known: Field, step: Step, point: Sequence[Fraction], most: int, leading: int
) -> tuple[list[Number], list[Number], Number]:
    """Coefficients of h⁰ … in det J − 1; in the map less the flow (the larger of two); leading.

    `point`: p, q and t.
    """
    x, y, t = (flint.arb(number(z)) for z in point)
    h = flint.arb_series([0, 1], most + 1)
    zero = 0 * h
    (p_next, q_next), (a, b, c, d) = step(x + zero, y + zero, h, t + zero)
    ps, qs = flow_series(known, x, y, t, most)
    value = Expansion(known.tape, [leading])
    value.begin(x, y, t)
    area = coefficients_of(a * d - b * c - 1 + zero, most)
    along = [coefficients_of(z + zero, most) for z in (p_next, q_next)]
    apart = [
        max(u - v, w - s, key=lambda ball: not ball.contains(0))
        for u, v, w, s in zip(along[0], ps, along[1], qs, strict=True)
    ]
    return area, apart, value.value(leading)


def coefficients_of(series: Any, most: int) -> list[Number]:
    return [series[k] for k in range(most + 1)]


def shown(ball: Number, digits: int) -> str:
    """The ball's middle, with two digits more than those."""
    return str(ball.str(digits + 2, radius=False))


def _points(data: Data) -> list[tuple[Fraction, Fraction, Fraction]]:
    """Points near the initial values, of no pattern, with times; p and q are other than 0."""
    starts = dict.fromkeys(
        (run.start["p"], run.start["q"], run.start.get("t", Fraction(0))) for run in data.runs
    )
    found = []
    for p, q, t in list(starts)[:3]:
        p, q = p or q / 3 or Fraction(2, 3), q or p / 5 or Fraction(4, 5)
        found += [
            (p * Fraction(29, 31), q * Fraction(17, 16), t + Fraction(3, 11)),
            (p * Fraction(-5, 7), q, t - Fraction(6, 13)),
        ]
    return found


@contextmanager
def length_of_series(length: int) -> Iterator[None]:
    """flint's length of power series, set for a while and given back."""
    before, flint.ctx.cap = flint.ctx.cap, length
    try:
        yield
    finally:
        flint.ctx.cap = before
