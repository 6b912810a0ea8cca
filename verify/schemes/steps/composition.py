"""The composition of two steps, each as power series in h: Ψ_h(Φ_h(z)), and Φ_(−h)(Φ_h(z))."""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.power_series import Derivatives, Series, expand_at
from verify.hamiltonians.canonical_field import VectorField
from verify.schemes.steps.step_algebra import Number, Recent, SeriesAlgebra, State, Step


def moves_of(field: VectorField, step: State) -> list[tuple[str, Series]]:
    """Return the displacement of each coordinate by a step, and of t if the system has it."""
    ring, most = field.ring, step[0].most
    moves = [
        (name, y - Series.from_coefficients(ring, [z], most))
        for name, y, z in zip(field.names, step, field.start, strict=True)
    ]
    if field.timed:
        moves.append(("t", Series.from_coefficients(ring, [ring.zero, ring.one], most)))
    return moves


def compose(field: VectorField, outer: Sequence[Series], step: State) -> list[Series]:
    """Return Σ hⁿ xₙ(z') for each series Σ hⁿ xₙ(z); xₙ is taken at t + h if t occurs."""
    ring, moves = field.ring, moves_of(field, step)
    results = []
    for x in outer:
        total = Series.from_coefficients(ring, [], x.most)
        for n, coefficient in enumerate(x.coefficients):
            # Of hⁿ times a series no more is needed than its terms up to h^(most − n).
            moved = expand_at(Derivatives(ring, coefficient), moves, x.most - n)
            total += Series.from_coefficients(ring, moved.coefficients, x.most).shift(n)
        results.append(total)
    return results


def reverse(x: Series) -> Series:
    """Return the series with −h in place of h."""
    return Series(x.ring, tuple(c * (-1) ** n for n, c in enumerate(x.coefficients)))


def start_of(field: VectorField, most: int) -> list[Series]:
    """Return the coordinates z as series."""
    return [Series.from_coefficients(field.ring, [z], most) for z in field.start]


class StepBack(SeriesAlgebra):
    """The step algebra of the step of −h that begins at z + `ahead`, and at t + h.

    Slopes of the step itself are taken there: so its coefficients, which may be long, need no
    expansion.
    """

    def __init__(
        self, field: VectorField, ahead: Sequence[Series], most: int, recent: "Recent | None" = None
    ) -> None:
        super().__init__(field, most, recent)
        self.ahead = list(map(self._cut, ahead))

    def up_to(self, most: int) -> SeriesAlgebra:
        return StepBack(self.field, self.ahead, most, self._recent)

    def along_flow(self, eta: int) -> list[Series]:
        moves, totals = self._moves([self.nothing] * self.size, Fraction(0)), []
        for k in range(self.size):
            total = self.nothing
            for n in range(1, min(eta, self.most) + 1):
                term = Derivatives(self.field.ring, self.field.term(n)[k])
                total += (
                    self._cut(expand_at(term, moves, self.most - n))
                    .shift(n)
                    .times(Fraction((-1) ** n))
                )
            totals.append(total)
        return totals

    def _slopes(
        self, changes: Sequence[Series], clock: Number, places: Sequence[int], reach: int
    ) -> list[Series]:
        moves = self._moves(changes, clock)
        return [expand_at(self.field.derivatives[k], moves, reach) for k in places]

    def _moves(self, changes: Sequence[Series], clock: Number) -> list[tuple[str, Series]]:
        pairs = zip(self.ahead, map(self._cut, changes), strict=True)
        moves = list(zip(self.field.names, (x + y for x, y in pairs), strict=True))
        if self.field.timed:
            ring = self.field.ring
            late = ring.one - (ring.constant(clock) if isinstance(clock, Fraction) else clock)
            moves.append(("t", Series.from_coefficients(ring, [ring.zero, late], self.most)))
        return [(name, x) for name, x in moves if not x.vanishes]

    def move(self, change: Series, weights: Sequence[Number], slopes: Sequence[Series]) -> Series:
        return super().move(change, weights, [x.times(Fraction(-1)) for x in slopes])


def step_back(field: VectorField, step: Step, end: State) -> list[Series]:
    """Return Φ_(−h)(z') by coordinates; `end`: z', which the step reaches."""
    most = end[0].most
    ahead = [x - z for x, z in zip(end, start_of(field, most), strict=True)]
    changes = step(StepBack(field, ahead, most))
    return [x + y for x, y in zip(end, changes, strict=True)]
