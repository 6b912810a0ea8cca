"""Formulas H(p1 … pn, q1 … qn), as text: a formula of the plane for each degree, and couplings.

The parts of the plane have no variable in common, and a coupling has variables of two degrees, so
that no term cancels another. H → ∞ in every direction where each part does and the couplings are
bounded below; H is open along an axis of the first degree where its part is.

Terms that couple two degrees of freedom, i and j: of q alone, of p alone, or of both.

Those of q alone or of p alone leave H = T + V; of the others a mixed derivative such as
∂²H/∂p1∂q2 is not the zero function. What is known of each: whether it is bounded below where its
coefficient is positive or it is bounded (`confined`), so that H → ∞ in every direction stays so;
and whether it is bounded on every axis (`flat`), so that an H that is open along one stays so.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

from hypothesis import strategies as st

from verify.errors import InputError
from verify.strategies.drives import driven
from verify.strategies.formulas import Formula, formulas
from verify.strategies.terms import Drawer, Limits, Sum, power, times


class Coupling(NamedTuple):
    """Numerator and denominator with p, q for the first degree and P, Q for the second."""

    numerator: str
    denominator: str = ""
    positive: bool = False  # whether the coefficient has to be


class Form(NamedTuple):
    """How a coupling is drawn, of which degree its polynomial is, and what is known of it."""

    draw: Callable[[Drawer], Coupling]
    kind: str
    separable: bool
    degree: int = 0
    confined: bool = False
    flat: bool = True


def _bilinear(d: Drawer) -> Coupling:
    return Coupling(d.pick(("q*Q", "p*P")))


def _springs(d: Drawer) -> Coupling:
    """A spring between two masses."""
    return Coupling("(q - Q)**2", positive=True)


def _henon_heiles(d: Drawer) -> Coupling:
    return Coupling(d.pick(("q**2*Q", "q*Q**2")))


def _squares(d: Drawer) -> Coupling:
    return Coupling(d.pick(("q**2*Q**2", "p**2*P**2")), positive=True)


def _rotation(d: Drawer) -> Coupling:
    return Coupling(d.pick(("p*Q", "P*q")))


def _magnetic(d: Drawer) -> Coupling:
    return Coupling(f"(p - {times(d.inner(), 'Q')})**2", positive=True)


def _mixed_power(d: Drawer) -> Coupling:
    return Coupling(f"{power('q', d.whole(1, 2))}*P")


def _mixed_squares(d: Drawer) -> Coupling:
    return Coupling(d.pick(("p**2*Q**2", "P**2*q**2")), positive=True)


def _waves(d: Drawer) -> Coupling:
    """What couples two pendulums."""
    return Coupling(f"{d.pick(('cos', 'sin'))}(q - {d.pick(('', '2*'))}Q)")


def _mixed_waves(d: Drawer) -> Coupling:
    return Coupling(f"{d.pick(('cos', 'sin'))}(p + {times(d.inner(), 'Q')})")


def _bumps(d: Drawer) -> Coupling:
    return Coupling(d.pick(("exp(-q**2 - Q**2)", "exp(-p**2 - P**2)")))


def _toda(d: Drawer) -> Coupling:
    return Coupling("exp(q - Q)", positive=True)


def _mixed_bumps(d: Drawer) -> Coupling:
    return Coupling(d.pick(("exp(-p**2 - Q**2)", "exp(-q**2 - P**2)")))


def _wells(d: Drawer) -> Coupling:
    """A soft well between two bodies."""
    return Coupling("", f"{d.whole(1, min(d.limits.size, 9))} + (q - Q)**2")


def _mixed_wells(d: Drawer) -> Coupling:
    return Coupling("q*P", f"{d.whole(1, min(d.limits.size, 9))} + q**2 + P**2")


_FORMS = (
    Form(_bilinear, "polynomial", True, 2),
    Form(_springs, "polynomial", True, 2, confined=True, flat=False),
    Form(_henon_heiles, "polynomial", True, 3),
    Form(_squares, "polynomial", True, 4, confined=True),
    Form(_rotation, "polynomial", False, 2),
    Form(_magnetic, "polynomial", False, 2, confined=True, flat=False),
    Form(_mixed_power, "polynomial", False, 3),
    Form(_mixed_squares, "polynomial", False, 4, confined=True),
    Form(_waves, "trigonometric", True, confined=True),
    Form(_mixed_waves, "trigonometric", False, confined=True),
    Form(_bumps, "exponential", True, confined=True),
    Form(_toda, "exponential", True, confined=True, flat=False),
    Form(_mixed_bumps, "exponential", False, confined=True),
    Form(_wells, "rational", True, confined=True),
    Form(_mixed_wells, "rational", False, confined=True),
)


def forms(kind: str, degree: int, *, separable: bool, bounded: bool | None) -> Iterator[Form]:
    """Those that an H of the kind may have, of a polynomial up to the degree, the simplest first.

    Of an H that is not of one variable each, those of both variables come first.
    """
    for form in sorted(_FORMS, key=lambda form: form.separable != separable):
        fits = form.kind in ("polynomial", kind) and form.degree <= degree
        known = {None: True, True: form.confined, False: form.flat}[bounded]
        if fits and known and (form.separable or not separable):
            yield form


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
