"""S = JᵀΩJ − Ω and ΔJ = det J − 1 of a map, as power series in h.

With N = Ω⁻¹S, det J² = det(1 + N), so that log det J = ½ tr(N − N²/2 + N³/3 − …). If S begins with
hᵐ, ΔJ = Σ S(p_i, q_i) up to h^(2m−1).
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, Generic, TypeVar

from verify.algebra.identities.polynomials import Poly
from verify.algebra.power_series import CoefficientRing, Series
from verify.hamiltonians.canonical_field import VectorField
from verify.schemes.steps.step_algebra import State
from verify.schemes.steps.two_form import TwoForm, wedge

F = TypeVar("F", bound=VectorField)
Matrix = list[list[Series]]


class DefectSeries(Generic[F]):
    """The coefficients of h⁰, h¹, … in z', S and ΔJ, computed as far as they are read.

    `expand(most)` returns H's field and z' up to h^most at least, over the field's ring.
    """

    def __init__(
        self, expand: Callable[[int], tuple[F, State]], first: int, flow_up_to: int = -1
    ) -> None:
        """`first`: the power of h that the first expansion reaches.

        `flow_up_to`: the power of h up to which the coefficients are the exact flow's.
        """
        self._expand, self._first, self._flow_up_to = expand, first, flow_up_to
        self._expansion: tuple[F, State] | None = None
        self._gradients: list[list[tuple[Poly, ...]]] = []
        self._forms: dict[int, TwoForm] = {}

    @property
    def flow(self) -> F:
        """The field of H, in the ring of the coefficients."""
        return self._expand_to(0)[0]

    def _expand_to(self, n: int) -> tuple[F, State]:
        if self._expansion is None or self._expansion[1][0].most < n:
            self._expansion = self._expand(self._first if n <= self._first else n + 1)
            self._gradients, self._forms = [], {}
        return self._expansion

    def coefficient(self, n: int) -> tuple[Poly, ...]:
        """Return the coefficients of hⁿ in z'."""
        return tuple(series.coefficients[n] for series in self._expand_to(n)[1])

    def differences(self, n: int) -> tuple[Any, list[Poly]]:
        """Return the ring, and the coefficients of hⁿ in z' less those of the exact flow."""
        flow, _ = self._expand_to(n)
        pairs = zip(self.coefficient(n), flow.term(n), strict=True)
        return flow.ring, [flow.ring.reduce(x - y) for x, y in pairs]

    def agrees(
        self, n: int, nearly: Callable[[Poly, Poly], bool] | None = None
    ) -> tuple[bool | None, Any, Poly]:
        """Return True if the coefficients of hⁿ in z' are the exact flow's, else False or None.

        With it: the ring and the first difference that is not shown to be 0. `nearly(gap, x)`: True
        if a gap counts as 0 beside the coefficient x.
        """
        flow, _ = self._expand_to(n)
        for x, gap in zip(self.coefficient(n), self.differences(n)[1], strict=True):
            if nearly is not None and nearly(gap, x):
                continue
            same = flow.ring.vanishes(gap)
            if same is not True:
                return same, flow.ring, gap
        return True, flow.ring, flow.ring.zero

    def _gradient(self, n: int) -> list[tuple[Poly, ...]]:
        """Return the coefficient of hⁿ in J, by rows."""
        flow, _ = self._expand_to(n)
        while (k := len(self._gradients)) <= n:
            gradients = flow.gradients(k) if k <= self._flow_up_to else None
            self._gradients.append(list(gradients or map(flow.gradient, self.coefficient(k))))
        return self._gradients[n]

    def form(self, m: int) -> TwoForm:
        """Return the coefficient of hᵐ in S."""
        flow, _ = self._expand_to(m)
        if m not in self._forms:
            ring, n = flow.ring, flow.degrees
            rows = [self._gradient(k) for k in range(m + 1)]

            def entry(a: int, b: int) -> Poly:
                total = -ring.one if m == 0 and b == a + n else ring.zero
                for k in range(m + 1):
                    for i in range(n):
                        # The Cauchy product in JᵀΩJ = Σ dp_i'∧dq_i'; Ω is subtracted at h⁰.
                        total += wedge(rows[k][i], rows[m - k][n + i], a, b)
                return total

            self._forms[m] = TwoForm.from_entries(ring, flow.names, entry)
        return self._forms[m]

    def volume(self, n: int) -> tuple[Any, Poly]:
        """Return the coefficient of hⁿ in ΔJ, with its ring."""
        if self.flow.degrees == 1:
            return self.flow.ring, self.form(n).entry(0, 1)
        return self.flow.ring, self.delta_j(n)[n]

    def delta_j(self, most: int) -> tuple[Poly, ...]:
        """Return the coefficients of h⁰ … h^most in ΔJ."""
        flow, _ = self._expand_to(most)
        forms = [self.form(m) for m in range(most + 1)]
        ring, size = flow.ring, len(flow.names)
        matrix = [[_entry_of_n(ring, forms, a, b, flow.degrees) for b in range(size)]
                  for a in range(size)]  # fmt: skip
        # N^k begins with h^(k·begins): only the powers up to k = most/begins count.
        begins = next((m for m, form in enumerate(forms) if form.entries), most + 1)
        total = Series.from_coefficients(ring, [], most)
        product: Matrix | None = None
        for k in range(1, most // max(begins, 1) + 1):
            product = matrix if product is None else _times(product, matrix)
            trace = product[0][0]
            for a in range(1, size):
                trace += product[a][a]
            total += trace.times(Fraction((-1) ** (k + 1), 2 * k))
        result, power = (
            Series.from_coefficients(ring, [], most),
            Series.from_coefficients(ring, [ring.one], most),
        )
        for k in range(1, most // max(begins, 1) + 1):
            power = (power * total).times(Fraction(1, k))
            result += power
        return result.coefficients


def defect_series_of(flow: F, after: Sequence[Sequence[Poly]]) -> DefectSeries[F]:
    """Return the series of a map; `after[k]`: the coefficients of h⁰, h¹, … in coordinate k."""
    state = tuple(Series(flow.ring, tuple(x)) for x in after)
    return DefectSeries(lambda _: (flow, state), state[0].most)


def _entry_of_n(ring: CoefficientRing, forms: Sequence[TwoForm], a: int, b: int, n: int) -> Series:
    """Return the entry ab of N = Ω⁻¹S."""
    row, sign = (a + n, -1) if a < n else (a - n, 1)
    return Series(ring, tuple(form.entry(row, b) * sign for form in forms))


def _times(x: Matrix, y: Matrix) -> Matrix:
    size, rows = range(len(x)), []
    for a in size:
        row = []
        for b in size:
            total = x[a][0] * y[0][b]
            for c in size[1:]:
                total += x[a][c] * y[c][b]
            row.append(total)
        rows.append(row)
    return rows
