"""Formulas H(p1 … pn, q1 … qn), as text: a formula of the plane for each degree, and couplings.

The parts of the plane have no variable in common, and a coupling has variables of two degrees, so
that no term cancels another. H → ∞ in every direction where each part does and the couplings are
bounded below; H is open along an axis of the first degree where its part is.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product

from hypothesis import strategies as st

from verify.errors import InputError
from verify.strategies.couplings import Form, forms
from verify.strategies.drives import driven
from verify.strategies.formulas import Formula, formulas
from verify.strategies.terms import Drawer, Limits, Sum

_VARIABLE = re.compile(r"\b[pqPQ]\b")


@dataclass(frozen=True)
class Wanted:
    """What is asked of an H in n degrees of freedom, as `hamiltonians` has it."""

    degrees: int
    kinds: tuple[str, ...]
    limits: Limits
    separable: bool | None = None
    bounded: bool | None = None
    coupled: bool | None = None
    with_parameters: bool = False
    time_dependent: bool = False

    def couplings(self, kind: str, separable: bool) -> list[Form]:
        """Those that such an H may have; InputError where it has to have one, and there is none."""
        degree = self.limits.degree
        found = list(forms(kind, degree, separable=separable, bounded=self.bounded))
        if not found and self.coupled:
            raise InputError("degree", degree, "must be 2 or more for a coupling of such an H")
        return found

    def part(
        self, kinds: Sequence[str], separable: bool | None, first: bool = False
    ) -> st.SearchStrategy[Formula]:
        """Formulas of the plane, for one degree of freedom; the `first` is what decides of all."""
        bounded = self.bounded if first or self.bounded else None
        named = self.with_parameters and first
        found = formulas(
            kinds, self.limits, separable=separable, bounded=bounded, with_parameters=named
        )
        if not (self.time_dependent and first):
            return found
        return driven(found, kinds, self.limits, linear=self.bounded is True)


def formulas_in_degrees(wanted: Wanted) -> st.SearchStrategy[Formula]:
    """As `verify.strategies.formulas.formulas`, in n degrees of freedom."""
    either = (True, False) if wanted.separable is None else (wanted.separable,)
    found, refused = [], []
    for kind, separable in product(wanted.kinds, either):
        try:
            found.append(_of_kind(wanted, kind, separable))
        except InputError as error:
            refused.append(error)
    if not found:
        raise refused[0]
    return st.one_of(found)


def _of_kind(wanted: Wanted, kind: str, separable: bool) -> st.SearchStrategy[Formula]:
    """Of the kind in its first degree of freedom; the others are so, or polynomials."""
    allowed = wanted.couplings(kind, separable) if wanted.coupled is not False else []
    first = wanted.part([kind], separable, first=True)
    kinds = dict.fromkeys(("polynomial", kind) if "polynomial" in wanted.kinds else (kind,))
    others = st.one_of([wanted.part([each], True if separable else None) for each in kinds])
    return _drawn(wanted, first, others, allowed, separable)


@st.composite
def _drawn(
    draw: st.DrawFn,
    wanted: Wanted,
    first: st.SearchStrategy[Formula],
    others: st.SearchStrategy[Formula],
    allowed: list[Form],
    separable: bool,
) -> Formula:
    parts = [draw(first), *(draw(others) for _ in range(wanted.degrees - 1))]
    text = _added(numbered(part.text, k, k) for k, part in enumerate(parts, start=1))
    d = Drawer(draw, wanted.limits)
    least = int(bool(wanted.coupled))
    count = d.whole(least, wanted.degrees - 1) if allowed else 0
    made: set[str] = set()
    for _ in range(count):
        i = d.whole(1, wanted.degrees - 1)
        term = _coupling(d, d.pick(allowed), i, d.whole(i + 1, wanted.degrees))
        if term.lstrip("+- ") not in made:
            made.add(term.lstrip("+- "))
            text += term
    return replace(parts[0], text=text, separable=separable)


def _coupling(d: Drawer, form: Form, i: int, j: int) -> str:
    """The term, with its sign."""
    numerator, denominator, positive = form.draw(d)
    term = Sum()
    term.add(d.positive() if positive else d.signed(), numerator, denominator)
    written = numbered(term.written({}), i, j)
    return f" - {written[1:]}" if written.startswith("-") else f" + {written}"


def numbered(text: str, i: int, j: int) -> str:
    """The text with p and q of degree i, P and Q of degree j.

    >>> numbered("p**2/2 + exp(q - Q)", 1, 2)
    'p1**2/2 + exp(q1 - q2)'
    """
    return _VARIABLE.sub(lambda found: found[0].lower() + str(j if found[0].isupper() else i), text)


def _added(parts: Iterable[str]) -> str:
    first, *others = parts
    signed = (f" - {x[1:]}" if x.startswith("-") else f" + {x}" for x in others)
    return first + "".join(signed)
