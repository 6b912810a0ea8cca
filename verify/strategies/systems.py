"""Formulas H(p, q) or H(p1 … pn, q1 … qn): one of q and p for each degree, and couplings.

The parts have no variable in common, and a coupling has variables of two degrees, so that no term
cancels another. H → ∞ in every direction where each part does and the couplings are bounded below;
H is open along an axis of the first degree where its part is.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

from hypothesis import strategies as st

from verify.errors import InputError
from verify.strategies.couplings import Coupling, couplings, number_variables, with_sign
from verify.strategies.drives import driven_formulas
from verify.strategies.formulas import KINDS, Formula, formulas
from verify.strategies.terms import Drawer, Limits


@dataclass(frozen=True)
class System:
    """The requested properties of an H; the fields are the arguments of `hamiltonians`."""

    degrees: int
    limits: Limits
    kinds: tuple[str, ...] = KINDS
    separable: bool | None = None
    bounded: bool | None = None
    coupled: bool | None = None
    with_parameters: bool = False
    time_dependent: bool = False

    def formulas(self) -> st.SearchStrategy[Formula]:
        """Return a strategy of all such formulas; InputError where no such H exists."""
        if self.degrees == 1:
            return self._first_formulas(self.kinds, self.separable)
        either = (True, False) if self.separable is None else (self.separable,)
        strategies, errors = [], []
        for kind, separable in product(self.kinds, either):
            try:
                strategies.append(self._formulas_of_kind(kind, separable))
            except InputError as error:
                errors.append(error)
        if not strategies:
            # All kinds failed; the first error is that of the simplest kind.
            raise errors[0]
        return st.one_of(strategies)

    def _first_formulas(
        self, kinds: Sequence[str], separable: bool | None
    ) -> st.SearchStrategy[Formula]:
        """Return formulas for the first degree of freedom, which fixes the kind of the whole H."""
        still = formulas(
            kinds,
            self.limits,
            separable=separable,
            bounded=self.bounded,
            with_parameters=self.with_parameters,
        )
        if not self.time_dependent:
            return still
        return driven_formulas(still, kinds, self.limits, linear=self.bounded is True)

    def _formulas_of_kind(self, kind: str, separable: bool) -> st.SearchStrategy[Formula]:
        """Return formulas whose first part is of the kind; the others may be polynomials."""
        kinds = dict.fromkeys(("polynomial", kind) if "polynomial" in self.kinds else (kind,))
        others = [
            # Only what must hold of every part is passed on: for `separable` False or `bounded`
            # False the first part, or a coupling, suffices.
            formulas([each], self.limits, separable=separable or None, bounded=self.bounded or None)
            for each in kinds
        ]
        first = self._first_formulas([kind], separable)
        return _draw_formula(
            self, first, st.one_of(others), self._couplings(kind, separable), separable
        )

    def _couplings(self, kind: str, separable: bool) -> list[Coupling]:
        """Return the couplings that such an H may have; InputError where it needs one in vain."""
        if self.coupled is False:
            return []
        degree = self.limits.degree
        candidates = list(couplings(kind, degree, separable=separable, bounded=self.bounded))
        if not candidates and self.coupled:
            raise InputError("degree", degree, "must be 2 or more for a coupling of such an H")
        return candidates


@st.composite
def _draw_formula(
    draw: st.DrawFn,
    system: System,
    first: st.SearchStrategy[Formula],
    others: st.SearchStrategy[Formula],
    candidates: list[Coupling],
    separable: bool,
) -> Formula:
    n = system.degrees
    parts = [draw(first), *(draw(others) for _ in range(n - 1))]
    texts = [number_variables(part.text, k, k) for k, part in enumerate(parts, start=1)]
    d = Drawer(draw, system.limits)
    # Keyed without their signs: a coupling and its opposite would cancel.
    terms: dict[str, str] = {}
    for _ in range(d.whole(int(bool(system.coupled)), n - 1) if candidates else 0):
        i = d.whole(1, n - 1)
        term = d.pick(candidates).draw_term(d, i, d.whole(i + 1, n))
        terms.setdefault(term.lstrip("+- "), term)
    text = "".join([texts[0], *map(with_sign, texts[1:]), *terms.values()])
    return replace(parts[0], text=text, separable=separable)
