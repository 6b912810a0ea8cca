"""Two-forms Σ c_ab dz_a∧dz_b, a < b, over the coordinates z = (p1 … pn, q1 … qn).

Ω = Σ dp_i∧dq_i. As a matrix a form is antisymmetric: c_ab stands above the diagonal, −c_ab below.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

from verify.algebra.power_series import CoefficientRing
from verify.algebra.ring import Decision, Poly
from verify.hamiltonians.canonical_field import VectorField

Place = tuple[int, int]
MOST_TERMS = 2000  # limit of the terms of a form that is written out


@dataclass(frozen=True)
class TwoForm:
    """A two-form: its coefficients c_ab ≠ 0 in normal form, by the places a < b."""

    ring: Any  # a `verify.algebra.power_series.CoefficientRing`
    names: tuple[str, ...]
    entries: Mapping[Place, Poly] = field(default_factory=dict)

    @classmethod
    def from_entries(
        cls, ring: CoefficientRing, names: tuple[str, ...], entry: Callable[[int, int], Poly]
    ) -> "TwoForm":
        """Return the form with the coefficients c_ab = entry(a, b), reduced to normal form."""
        coefficients = {
            place: ring.reduce(entry(*place)) for place in combinations(range(len(names)), 2)
        }
        return cls(ring, names, {place: x for place, x in coefficients.items() if not x.is_zero()})

    def entry(self, a: int, b: int) -> Poly:
        """Return the entry ab of its matrix."""
        if a > b:
            return -self.entry(b, a)
        return self.entries.get((a, b), self.ring.zero)

    def __sub__(self, other: "TwoForm") -> "TwoForm":
        return TwoForm.from_entries(
            self.ring, self.names, lambda a, b: self.entry(a, b) - other.entry(a, b)
        )

    def entry_name(self, place: Place) -> str:
        """Return an entry's name, such as dp1∧dq2."""
        a, b = (self.names[k] for k in place)
        return f"d{a}∧d{b}"

    @property
    def length(self) -> int:
        """The number of terms in all entries."""
        return sum(map(len, self.entries.values()))

    @property
    def text(self) -> str:
        """The form as a formula."""
        terms = (self._term(self.ring.text(x), place) for place, x in self.entries.items())
        return " + ".join(terms) or "0"

    def _term(self, coefficient: str, place: Place) -> str:
        return (
            self.entry_name(place)
            if coefficient == "1"
            else f"({coefficient})*{self.entry_name(place)}"
        )

    @property
    def divergence(self) -> Poly:
        """The sum Σ c_(p_i q_i): for S it is ΔJ up to products of entries of S."""
        n = len(self.names) // 2
        total: Poly = self.ring.reduce(
            sum((self.entry(i, n + i) for i in range(n)), self.ring.zero)
        )
        return total

    def decide(
        self, decide: Callable[[Poly], Decision] | None = None
    ) -> tuple[Decision, Place | None]:
        """Decide whether it is the zero form, and return an entry that shows that it is not;
        `decide` in place of the ring's own.

        Undecided where no entry is shown not to be zero, and one is not shown to be.
        """
        undecided = None
        for place, x in self.entries.items():
            decision = (decide or self.ring.decide)(x)
            if decision.zero is False:
                return decision, place
            if decision.zero is None:
                undecided = decision, place
        return undecided or (Decision(True), None)


def lie_derivative(flow: VectorField, form: TwoForm) -> TwoForm:
    """Return the Lie derivative along the flow, by X, or D = ∂_t + X if H depends on time.

    It is the derivatives of the entries plus AᵀB + BA, with A = f' and B the form's matrix.
    """
    ring, slopes = flow.ring, [flow.gradient(x) for x in flow.slopes]
    # In the plane AᵀB + BA is tr A = 0 times the entry.
    size = range(len(flow.names)) if flow.degrees > 1 else ()

    def entry(a: int, b: int) -> Poly:
        total = flow.derive(form.entry(a, b))
        for c in size:
            total += slopes[c][a] * form.entry(c, b) + form.entry(a, c) * slopes[c][b]
        return total

    return TwoForm.from_entries(ring, flow.names, entry)


def wedge(x: Sequence[Poly], y: Sequence[Poly], a: int, b: int) -> Poly:
    """Return the entry ab of dx∧dy from the gradients of x and y."""
    return x[a] * y[b] - x[b] * y[a]
