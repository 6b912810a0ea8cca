"""Terms that couple two degrees of freedom, i and j: of q alone, of p alone, or of both.

Those of q alone or of p alone leave H = T + V; the others have a mixed derivative such as
∂²H/∂p1∂q2 that is not the zero function. Two facts are stated of each: it is `confined` where it
is bounded below, by a positive coefficient or because it is bounded, so that H → ∞ in every
direction stays so; and `flat` where it is bounded on every axis, so that an H that is open along
one stays so.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from verify.strategies.terms import Drawer, TermSum

_VARIABLE = re.compile(r"\b[pqPQ]\b")


class Coupling(NamedTuple):
    """A term with q, p of one degree of freedom and Q, P of the other.

    `numerators`: one is drawn, with the numbers in it. `denominator`: a number is added to it.
    `degree`: that of the polynomial. `positive`: the coefficient has to be positive.
    """

    kind: str
    separable: bool
    numerators: tuple[str, ...]
    denominator: str = ""
    degree: int = 0
    positive: bool = False
    confined: bool = False
    flat: bool = True

    def draw_sides(self, d: Drawer) -> tuple[str, str]:
        """Draw a numerator and a denominator."""
        numerator = d.fill_braces(d.pick(self.numerators))
        if not self.denominator:
            return numerator, ""
        return numerator, f"{d.whole(1, min(d.limits.size, 9))} + {self.denominator}"

    def draw_term(self, d: Drawer, i: int, j: int) -> str:
        """Draw the term of degrees of freedom i and j, with its sign."""
        term, sides = TermSum(), self.draw_sides(d)
        term.add(d.positive() if self.positive else d.nonzero(), *sides)
        return with_sign(number_variables(term.to_text({}), i, j))


# `positive` stands where a term is ≥ 0 and only a positive coefficient keeps H bounded below.
_COUPLINGS = (
    Coupling("polynomial", True, ("q*Q", "p*P"), degree=2),
    Coupling("polynomial", True, ("(q - Q)**2",), degree=2, positive=True, confined=True,
             flat=False),  # a spring between two masses
    Coupling("polynomial", True, ("q**2*Q", "q*Q**2"), degree=3),  # as in that of Hénon and Heiles
    Coupling("polynomial", True, ("q**2*Q**2", "p**2*P**2"), degree=4, positive=True,
             confined=True),
    Coupling("polynomial", False, ("p*Q", "P*q"), degree=2),  # a rotation
    Coupling("polynomial", False, ("(p - {3}Q)**2",), degree=2, positive=True, confined=True,
             flat=False),  # a magnetic field
    Coupling("polynomial", False, ("q*P", "q**2*P"), degree=3),
    Coupling("polynomial", False, ("p**2*Q**2", "P**2*q**2"), degree=4, positive=True,
             confined=True),
    Coupling("trigonometric", True, ("cos(q - {2}Q)", "sin(q - {2}Q)"), confined=True),  # pendulums
    Coupling("trigonometric", False, ("cos(p + {3}Q)", "sin(p + {3}Q)"), confined=True),
    Coupling("exponential", True, ("exp(-q**2 - Q**2)", "exp(-p**2 - P**2)"), confined=True),
    Coupling("exponential", True, ("exp(q - Q)",), positive=True, confined=True,
             flat=False),  # as in Toda's lattice
    Coupling("exponential", False, ("exp(-p**2 - Q**2)", "exp(-q**2 - P**2)"), confined=True),
    Coupling("rational", True, ("",), "(q - Q)**2", confined=True),  # a soft well between bodies
    Coupling("rational", False, ("q*P",), "q**2 + P**2", confined=True),
)  # fmt: skip


def couplings(
    kind: str, degree: int, *, separable: bool, bounded: bool | None
) -> Iterator[Coupling]:
    """Yield the couplings that an H of the kind may have, the simplest first.

    Polynomial ones are of the given degree at most. Where H need not be separable, those of both
    q and p come first.
    """
    for coupling in sorted(_COUPLINGS, key=lambda x: x.separable != separable):
        fits = coupling.kind in ("polynomial", kind) and coupling.degree <= degree
        # Where `bounded` is None any coupling will do; True needs one that keeps H → ∞ in every
        # direction, False one that is bounded on the axis along which H is open.
        suits = {None: True, True: coupling.confined, False: coupling.flat}[bounded]
        if fits and suits and (coupling.separable or not separable):
            yield coupling


def number_variables(text: str, i: int, j: int) -> str:
    """Return the text with q and p of degree of freedom i, Q and P of degree j.

    >>> number_variables("p**2/2 + exp(q - Q)", 1, 2)
    'p1**2/2 + exp(q1 - q2)'
    """
    return _VARIABLE.sub(lambda match: match[0].lower() + str(j if match[0].isupper() else i), text)


def with_sign(text: str) -> str:
    """Return the text with its sign, to be added to others.

    >>> with_sign("-q") + with_sign("p")
    ' - q + p'
    """
    return f" - {text[1:]}" if text.startswith("-") else f" + {text}"
