"""What is proved of a scheme in n degrees of freedom, looked at again at some points.

As `verify.reference.check.recompute_proof` in the plane: the step is done with power series in h,
and what is looked at are the powers of h in S = JᵀΩJ − Ω and in the map.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import combinations

import flint

from verify.reference.check.difference import Place
from verify.reference.check.recompute_proof import (
    ANY_ORDER,
    BITS,
    MOST_ORDER,
    coefficients_of,
    length_of_series,
    shown,
)
from verify.reference.check.taylor import Expansion, Number, number
from verify.reference.check.textbook_in_degrees import (
    FieldInDegrees,
    Step,
    defect,
    flow_series,
    step_of,
)
from verify.reference.make.models_in_degrees import DataInDegrees, ProofInDegrees

Point = Mapping[str, Fraction]
Powers = Mapping[str, list[Number]]  # coefficients of h⁰ … by an entry's or a coordinate's name
_MORE_OF_FEW = 6  # orders looked at beyond those of a scheme whose S vanishes


def proof_again(
    known: FieldInDegrees, data: DataInDegrees, proof: ProofInDegrees, file: Place
) -> None:
    """The powers of h in S and in the map, at points near the initial values.

    That a coefficient vanishes for every z is not seen so, but that it does not is.
    """
    row = file.at(f"proof of {proof.scheme}")
    claims = {"order": proof.order, "convergence_order": proof.convergence_order}
    for column, given in claims.items():
        if (given or 0) > ANY_ORDER:
            row.differs(column, f"at most {ANY_ORDER}", str(given))
            return
    most = max(proof.order or min(MOST_ORDER, _MORE_OF_FEW), (proof.convergence_order or 0) + 1)
    looking = _Looking(known, proof, row, most)
    for point in _points(data):
        with flint.ctx.workprec(BITS), length_of_series(most + 1):
            looking.at(point)
    looking.end()


class _Looking:
    """One proof's coefficients at one point after another."""

    def __init__(self, known: FieldInDegrees, proof: ProofInDegrees, row: Place, most: int) -> None:
        self.known, self.proof, self.row, self.most = known, proof, row, most
        self.step = step_of(proof.scheme, known)
        self.leading = {at: known.tape.read(x) for at, x in proof.leading.items()}
        self.looked, self.seen = 0, {"order": False, "convergence_order": False}

    def at(self, point: Point) -> None:
        form, apart, leading = _powers(self.known, self.step, point, self.most, self.leading)
        every = [*(x for own in (*form.values(), *apart.values()) for x in own)]
        if not all(x.is_finite() for x in (*every, *leading.values())):
            return
        self.looked += 1
        order, convergence = self.proof.order, self.proof.convergence_order
        self._vanish("order", form, self.most + 1 if order is None else order)
        self._vanish("convergence_order", apart,
                     self.most if convergence is None else convergence + 1)  # fmt: skip
        if order is not None:
            self._leads(form, leading, order)
        if convergence is not None:
            self.seen["convergence_order"] |= _some(apart, convergence + 1)

    def _leads(self, form: Powers, leading: Mapping[str, Number], order: int) -> None:
        self.seen["order"] |= _some(form, order)
        if not leading:  # too long to be written out
            return
        for entry, powers in form.items():
            given = leading.get(entry, flint.arb(0))
            wanted = f"{shown(powers[order], 20)} at a point"
            same = (powers[order] - given).contains(0)
            self.row.must(same, f"leading {entry}", wanted, shown(given, 20))

    def _vanish(self, column: str, found: Powers, below: int) -> None:
        for name, powers in found.items():
            for k, c in enumerate(powers[:below]):
                if not c.contains(0):
                    least = k if column == "order" else k - 1
                    wanted = f"{least}, since that of h^{k} in {name} is {shown(c, 12)}"
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


def _some(found: Powers, k: int) -> bool:
    """Whether a coefficient of h^k does not vanish."""
    return any(not powers[k].contains(0) for powers in found.values())


def _powers(
    known: FieldInDegrees, step: Step, point: Point, most: int, leading: Mapping[str, int]
) -> tuple[Powers, Powers, Mapping[str, Number]]:
    """Coefficients of h⁰ … in the entries of S, and in the map less the flow; the leading ones."""
    z = [flint.arb(number(point[name])) for name in known.names]
    t = flint.arb(number(point["t"]))
    h = flint.arb_series([0, 1], most + 1)
    zero = 0 * h
    after, jacobian = step([x + zero for x in z], h, t + zero)
    flow = flow_series(known, z, t, most)
    form = defect([[x + zero for x in row] for row in jacobian])
    names = known.names
    entries = {
        f"d{names[a]}∧d{names[b]}": coefficients_of(form[a][b] + zero, most)
        for a, b in combinations(range(len(names)), 2)
    }
    apart = {
        name: [u - x[k] for u, x in zip(coefficients_of(after[k] + zero, most), flow, strict=True)]
        for k, name in enumerate(names)
    }
    values = Expansion(known.tape, list(leading.values()))
    values.begin_at(known.point(z, t))
    return entries, apart, {name: values.value(x) for name, x in leading.items()}


def _points(data: DataInDegrees) -> Iterator[Point]:
    """Points near the initial values, of no pattern, with times; no coordinate is 0."""
    starts = {run.q + run.p: run.start for run in data.runs}
    for start in list(starts.values())[:2]:
        for j, factor in enumerate((Fraction(29, 31), Fraction(-5, 7))):
            point = {
                name: (x or Fraction(2, 3)) * (factor + Fraction(k + 1, 40))
                for k, (name, x) in enumerate(start.items())
            }
            yield point | {"t": start.get("t", Fraction(0)) + Fraction(3 - 9 * j, 11 + 2 * j)}
