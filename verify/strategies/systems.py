"""Formulas H(p, q) or H(p1 … pn, q1 … qn): a formula of p and q for each degree, and couplings.

The parts have no variable in common, and a coupling has variables of two degrees, so that no term
cancels another. H → ∞ in every direction where each part does and the couplings are bounded below;
H is open along an axis of the first degree where its part is.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

from hypothesis import strategies as st

from verify.errors import InputError
from verify.strategies.couplings import Coupling, couplings, numbered, signed
from verify.strategies.drives import driven
from verify.strategies.formulas import KINDS, Formula, formulas
from verify.strategies.terms import Drawer, Limits


@dataclass(frozen=True)
class System:
    """What is asked of an H, as `hamiltonians` has it."""

    degrees: int
    limits: Limits
    kinds: tuple[str, ...] = KINDS
    separable: bool | None = None
    bounded: bool | None = None
    coupled: bool | None = None
    with_parameters: bool = False
    time_dependent: bool = False

    def formulas(self) -> st.SearchStrategy[Formula]:
        """All that is asked for; InputError where no such H exists."""
        if self.degrees == 1:
            return self._first(self.kinds, self.separable)
        either = (True, False) if self.separable is None else (self.separable,)
        drawn, refused = [], []
        for kind, separable in product(self.kinds, either):
            try:
                drawn.append(self._of_kind(kind, separable))
            except InputError as error:
                refused.append(error)
        if not drawn:
            raise refused[0]
        return st.one_of(drawn)

    def _first(self, kinds: Sequence[str], separable: bool | None) -> st.SearchStrategy[Formula]:
        """Formulas for the first degree of freedom, which decides of all."""
        still = formulas(
            kinds,
            self.limits,
            separable=separable,
            bounded=self.bounded,
            with_parameters=self.with_parameters,
        )
        if not self.time_dependent:
            return still
        return driven(still, kinds, self.limits, linear=self.bounded is True)

    def _of_kind(self, kind: str, separable: bool) -> st.SearchStrategy[Formula]:
        """Of the kind in its first degree of freedom; the others are so, or polynomials."""
        kinds = dict.fromkeys(("polynomial", kind) if "polynomial" in self.kinds else (kind,))
        others = [
            formulas([each], self.limits, separable=separable or None, bounded=self.bounded or None)
            for each in kinds
        ]
        first = self._first([kind], separable)
        return _drawn(self, first, st.one_of(others), self._couplings(kind, separable), separable)

    def _couplings(self, kind: str, separable: bool) -> list[Coupling]:
        """Those that such an H may have; InputError where it has to have one, and there is none."""
        if self.coupled is False:
            return []
        degree = self.limits.degree
        allowed = list(couplings(kind, degree, separable=separable, bounded=self.bounded))
        if not allowed and self.coupled:
            raise InputError("degree", degree, "must be 2 or more for a coupling of such an H")
        return allowed


@st.composite
def _drawn(
    draw: st.DrawFn,
    system: System,
    first: st.SearchStrategy[Formula],
    others: st.SearchStrategy[Formula],
    allowed: list[Coupling],
    separable: bool,
) -> Formula:
    n = system.degrees
    parts = [draw(first), *(draw(others) for _ in range(n - 1))]
    texts = [numbered(part.text, k, k) for k, part in enumerate(parts, start=1)]
    d = Drawer(draw, system.limits)
    terms: dict[str, str] = {}  # one of each, whatever its sign
    for _ in range(d.whole(int(bool(system.coupled)), n - 1) if allowed else 0):
        i = d.whole(1, n - 1)
        term = d.pick(allowed).term(d, i, d.whole(i + 1, n))
        terms.setdefault(term.lstrip("+- "), term)
    text = "".join([texts[0], *map(signed, texts[1:]), *terms.values()])
    return replace(parts[0], text=text, separable=separable)
