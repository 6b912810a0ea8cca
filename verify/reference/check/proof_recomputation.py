"""What is proved of a scheme, examined again: powers of h in S and in the map, at some points.

The step is done with power series in h for z and the Jacobian, whose coefficients are balls. In the
plane, S = JᵀΩJ − Ω has one entry, which is ΔJ.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

import flint

from verify.arithmetic.flint_precision import length_of_series
from verify.reference.check.difference import DataPlace
from verify.reference.check.taylor import Number, TapeExpansion, number
from verify.reference.check.textbook import Step, TextbookField, defect, flow_series, step_of
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


def recompute_proof(field: TextbookField, data: AnyData, proof: AnyProof, file: DataPlace) -> None:
    """Compute the powers of h in S and in the map, at points near the initial values.

    Values at points cannot show that a coefficient vanishes for every z, but they show where it
    does not.
    """
    order, convergence = proof.order, proof.convergence_order
    row = file.at_row(f"proof of {proof.scheme}")
    for column, claimed in (("order", order), ("convergence_order", convergence)):
        if (claimed or 0) > _ANY_ORDER:
            row.differs(column, f"at most {_ANY_ORDER}", str(claimed))
            return
    unordered = _MOST_ORDER if field.degrees == 1 else _OF_SEVERAL
    examination = _Examination(field, proof, row, max(order or unordered, (convergence or 0) + 1))
    for point in _points(field, data):
        with flint.ctx.workprec(_BITS), length_of_series(examination.most + 1):
            examination.examine(point)
    examination.finish()


class _Examination:
    """The coefficients of one proof at one point after another."""

    def __init__(self, field: TextbookField, proof: AnyProof, row: DataPlace, most: int) -> None:
        self.field, self.proof, self.row, self.most = field, proof, row, most
        self.step = step_of(proof.scheme, field)
        self.leading = {name: field.tape.read(x) for name, x in proof.entries.items()}
        self.examined, self.nonzero_seen = 0, {"order": False, "convergence_order": False}

    def examine(self, point: Point) -> None:
        """Compare the coefficients at a point with what is claimed of them."""
        form, map_error, leading = _expand(self.field, self.step, point, self.most, self.leading)
        coefficients = [x for powers in (*form.values(), *map_error.values()) for x in powers]
        # H is not defined at this point, or not on the way of the step: the point says nothing.
        if not all(x.is_finite() for x in (*coefficients, *leading.values())):
            return
        self.examined += 1
        order, convergence = self.proof.order, self.proof.convergence_order
        self._check_vanishing("order", form, self.most + 1 if order is None else order)
        upto = self.most - 1 if convergence is None else convergence
        self._check_vanishing("convergence_order", map_error, upto + 1)
        if order is not None:
            self._check_leading(form, leading, order)
        if convergence is not None:
            self.nonzero_seen["convergence_order"] |= _is_nonzero_at(map_error, convergence + 1)

    def _check_leading(self, form: Powers, leading: Mapping[str, Number], order: int) -> None:
        self.nonzero_seen["order"] |= _is_nonzero_at(form, order)
        if not leading:  # too long to be written out
            return
        for name, powers in form.items():
            lead = leading.get(name, flint.arb(0))
            expected = f"{format_ball(powers[order], 20)} at a point"
            same = (powers[order] - lead).contains(0)
            # Overlapping balls do not prove equality; disjoint ones refute it, which is all that is
            # needed.
            self.row.require(same, f"leading {name}".strip(), expected, format_ball(lead, 20))

    def _check_vanishing(self, column: str, powers_by_name: Powers, below: int) -> None:
        for k in range(below):
            for name, powers in powers_by_name.items():
                if not powers[k].contains(0):
                    plane = self.field.degrees == 1
                    coefficient = (
                        f"the coefficient of h^{k}" if plane else f"that of h^{k} in {name}"
                    )
                    least = k if column == "order" else k - 1
                    expected = f"{least}, since {coefficient} is {format_ball(powers[k], 12)}"
                    self.row.differs(column, expected, str(getattr(self.proof, column)))
                    return

    def finish(self) -> None:
        """Report each coefficient that is claimed not to vanish and vanished at every point."""
        if not self.examined:
            self.row.is_left_out("H is not defined nearby")
            return
        self.row.findings.recomputed += 1
        for column, nonzero in self.nonzero_seen.items():
            claimed = getattr(self.proof, column)
            expected = "more, since that coefficient is 0"
            self.row.require(nonzero or claimed is None, column, expected, str(claimed))


def _is_nonzero_at(powers_by_name: Powers, k: int) -> bool:
    """Return True if some coefficient of h^k does not vanish."""
    return any(not powers[k].contains(0) for powers in powers_by_name.values())


def _expand(
    field: TextbookField, step: Step, point: Point, most: int, leading: Mapping[str, int]
) -> tuple[Powers, Powers, Mapping[str, Number]]:
    """Return the coefficients of h⁰ … in the entries of S and in the map minus the flow, and the
    leading ones."""
    names = field.names
    z, t = [flint.arb(number(point[name])) for name in names], flint.arb(number(point["t"]))
    # h is a power series variable: the step's arithmetic then yields all coefficients at once.
    h = flint.arb_series([0, 1], most + 1)
    zero = 0 * h
    after, jacobian = step(z, h, t)
    form = {
        _AREA if field.degrees == 1 else f"d{names[a]}∧d{names[b]}": _coefficients(x + zero, most)
        for (a, b), x in defect(jacobian, field.degrees).items()
    }
    flow = zip(*flow_series(field.slopes, z, t, most), strict=True)
    map_error = {
        name: [u - v for u, v in zip(_coefficients(x + zero, most), series, strict=True)]
        for name, x, series in zip(names, after, flow, strict=True)
    }
    values = TapeExpansion(field.tape, list(leading.values()))
    values.begin([*z, t])
    return form, map_error, {name: values.value(x) for name, x in leading.items()}


def _coefficients(series: Any, most: int) -> list[Number]:
    return [series[k] for k in range(most + 1)]


def format_ball(ball: Number, digits: int) -> str:
    """Return the ball's midpoint, with two digits more than `digits`."""
    return str(ball.str(digits + 2, radius=False))


def _points(field: TextbookField, data: AnyData) -> Iterator[Point]:
    """Yield points near the initial values, without a pattern, with times; no coordinate is 0."""
    momenta, positions = field.names[: field.degrees], field.names[field.degrees :]
    starts = {tuple(run.start.values()): run.start for run in data.runs}
    for start in list(starts.values())[:3]:
        for by_p, by_q, delay in _MOVES:
            point = {"t": start.get("t", Fraction(0)) + delay}
            for k, (p, q) in enumerate(zip(momenta, positions, strict=True)):
                x, y, shift = start[p], start[q], Fraction(k, 40)
                point[p] = (x or y / 3 or Fraction(2, 3)) * (by_p + shift)
                point[q] = (y or x / 5 or Fraction(4, 5)) * (by_q + shift)
            yield point
