"""What is proved of a scheme, looked at again: powers of h in S and in the map, at some points.

The step is done with power series in h for z and the Jacobian: their coefficients are balls. Of
S = JᵀΩJ − Ω there is one entry in the plane, which is ΔJ.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

import flint

from verify.arithmetic.flint_precision import length_of_series
from verify.reference.check.difference import Place
from verify.reference.check.taylor import Expansion, Number, number
from verify.reference.check.textbook import Field, Step, defect, flow_series, step_of
from verify.reference.make.models import AnyData, AnyProof

Point = Mapping[str, Fraction]
Powers = Mapping[str, list[Number]]  # coefficients of h⁰ … by an entry's or a coordinate's name
_MOST_ORDER, _OF_SEVERAL = 12, 6  # to which an S is looked at that vanishes
_ANY_ORDER = 100  # beyond which no proof goes
_BITS = 512
_MOVES = (  # factors of p and of q, and how much later
    (Fraction(29, 31), Fraction(17, 16), Fraction(3, 11)),
    (Fraction(-5, 7), Fraction(1), Fraction(-6, 13)),
)
_AREA = ""  # the name of the only entry of S in the plane


def proof_again(known: Field, data: AnyData, proof: AnyProof, file: Place) -> None:
    """The powers of h in S and in the map, at points near the initial values.

    That a coefficient vanishes for every z is not seen so, but that it does not is.
    """
    order, convergence = proof.order, proof.convergence_order
    row = file.at(f"proof of {proof.scheme}")
    for column, claimed in (("order", order), ("convergence_order", convergence)):
        if (claimed or 0) > _ANY_ORDER:
            row.differs(column, f"at most {_ANY_ORDER}", str(claimed))
            return
    unordered = _MOST_ORDER if known.degrees == 1 else _OF_SEVERAL
    looking = _Looking(known, proof, row, max(order or unordered, (convergence or 0) + 1))
    for point in _points(known, data):
        with flint.ctx.workprec(_BITS), length_of_series(looking.most + 1):
            looking.at(point)
    looking.end()


class _Looking:
    """One proof's coefficients at one point after another."""

    def __init__(self, known: Field, proof: AnyProof, row: Place, most: int) -> None:
        self.known, self.proof, self.row, self.most = known, proof, row, most
        self.step = step_of(proof.scheme, known)
        self.leading = {name: known.tape.read(x) for name, x in proof.entries.items()}
        self.looked, self.seen = 0, {"order": False, "convergence_order": False}

    def at(self, point: Point) -> None:
        form, apart, leading = _powers(self.known, self.step, point, self.most, self.leading)
        every = [x for powers in (*form.values(), *apart.values()) for x in powers]
        if not all(x.is_finite() for x in (*every, *leading.values())):
            return
        self.looked += 1
        order, convergence = self.proof.order, self.proof.convergence_order
        self._vanish("order", form, self.most + 1 if order is None else order)
        upto = self.most - 1 if convergence is None else convergence
        self._vanish("convergence_order", apart, upto + 1)
        if order is not None:
            self._leads(form, leading, order)
        if convergence is not None:
            self.seen["convergence_order"] |= _some(apart, convergence + 1)

    def _leads(self, form: Powers, leading: Mapping[str, Number], order: int) -> None:
        self.seen["order"] |= _some(form, order)
        if not leading:  # too long to be written out
            return
        for name, powers in form.items():
            lead = leading.get(name, flint.arb(0))
            wanted = f"{shown(powers[order], 20)} at a point"
            same = (powers[order] - lead).contains(0)
            self.row.must(same, f"leading {name}".strip(), wanted, shown(lead, 20))

    def _vanish(self, column: str, every: Powers, below: int) -> None:
        for k in range(below):
            for name, powers in every.items():
                if not powers[k].contains(0):
                    plane = self.known.degrees == 1
                    what = f"the coefficient of h^{k}" if plane else f"that of h^{k} in {name}"
                    least = k if column == "order" else k - 1
                    wanted = f"{least}, since {what} is {shown(powers[k], 12)}"
                    self.row.differs(column, wanted, str(getattr(self.proof, column)))
                    return

    def end(self) -> None:
        """What was claimed not to vanish, and did wherever it was looked at."""
        if not self.looked:
            self.row.is_left_out("H is not defined nearby")
            return
        self.row.findings.recomputed += 1
        for column, seen in self.seen.items():
            claimed = getattr(self.proof, column)
            wanted = "more, since that coefficient is 0"
            self.row.must(seen or claimed is None, column, wanted, str(claimed))


def _some(every: Powers, k: int) -> bool:
    """Whether a coefficient of h^k does not vanish."""
    return any(not powers[k].contains(0) for powers in every.values())


def _powers(
    known: Field, step: Step, point: Point, most: int, leading: Mapping[str, int]
) -> tuple[Powers, Powers, Mapping[str, Number]]:
    """Coefficients of h⁰ … in the entries of S, and in the map less the flow; the leading ones."""
    names = known.names
    z, t = [flint.arb(number(point[name])) for name in names], flint.arb(number(point["t"]))
    h = flint.arb_series([0, 1], most + 1)
    zero = 0 * h
    after, jacobian = step(z, h, t)
    form = {
        _AREA if known.degrees == 1 else f"d{names[a]}∧d{names[b]}": _coefficients(x + zero, most)
        for (a, b), x in defect(jacobian, known.degrees).items()
    }
    flow = zip(*flow_series(known.slopes, z, t, most), strict=True)
    apart = {
        name: [u - v for u, v in zip(_coefficients(x + zero, most), series, strict=True)]
        for name, x, series in zip(names, after, flow, strict=True)
    }
    values = Expansion(known.tape, list(leading.values()))
    values.begin([*z, t])
    return form, apart, {name: values.value(x) for name, x in leading.items()}


def _coefficients(series: Any, most: int) -> list[Number]:
    return [series[k] for k in range(most + 1)]


def shown(ball: Number, digits: int) -> str:
    """The ball's middle, with two digits more than those."""
    return str(ball.str(digits + 2, radius=False))


def _points(known: Field, data: AnyData) -> Iterator[Point]:
    """Points near the initial values, of no pattern, with times; no coordinate is 0."""
    momenta, places = known.names[: known.degrees], known.names[known.degrees :]
    starts = {tuple(run.start.values()): run.start for run in data.runs}
    for start in list(starts.values())[:3]:
        for by_p, by_q, later in _MOVES:
            point = {"t": start.get("t", Fraction(0)) + later}
            for k, (p, q) in enumerate(zip(momenta, places, strict=True)):
                x, y, more = start[p], start[q], Fraction(k, 40)
                point[p] = (x or y / 3 or Fraction(2, 3)) * (by_p + more)
                point[q] = (y or x / 5 or Fraction(4, 5)) * (by_q + more)
            yield point
