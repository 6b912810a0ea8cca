"""Terms that couple two degrees of freedom, i and j: of q alone, of p alone, or of both.

Those of q alone or of p alone leave H = T + V; of the others a mixed derivative such as
∂²H/∂p1∂q2 is not the zero function. What is known of each: whether it is bounded below where its
coefficient is positive or it is bounded (`confined`), so that H → ∞ in every direction stays so;
and whether it is bounded on every axis (`flat`), so that an H that is open along one stays so.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from verify.strategies.terms import Drawer, Sum

_VARIABLE = re.compile(r"\b[pqPQ]\b")


class Coupling(NamedTuple):
    """A term with p, q of one degree and P, Q of the other; of which degree its polynomial is.

    `numerators`: one is drawn, with the numbers in it. `denominator`: a number is added to it.
    `positive`: whether the coefficient has to be.
    """

    kind: str
    separable: bool
    numerators: tuple[str, ...]
    denominator: str = ""
    degree: int = 0
    positive: bool = False
    confined: bool = False
    flat: bool = True

    def sides(self, d: Drawer) -> tuple[str, str]:
        """A numerator and a denominator, drawn."""
        numerator = d.filled(d.pick(self.numerators))
        if not self.denominator:
            return numerator, ""
        return numerator, f"{d.whole(1, min(d.limits.size, 9))} + {self.denominator}"

    def term(self, d: Drawer, i: int, j: int) -> str:
        """The term of degrees i and j, drawn, with its sign."""
        term, sides = Sum(), self.sides(d)
        term.add(d.positive() if self.positive else d.signed(), *sides)
        return signed(numbered(term.written({}), i, j))


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
    """Those that an H of the kind may have, of a polynomial up to the degree, the simplest first.

    Of an H that is not of one variable each, those of both variables come first.
    """
    for each in sorted(_COUPLINGS, key=lambda each: each.separable != separable):
        fits = each.kind in ("polynomial", kind) and each.degree <= degree
        suits = {None: True, True: each.confined, False: each.flat}[bounded]
        if fits and suits and (each.separable or not separable):
            yield each


def numbered(text: str, i: int, j: int) -> str:
    """The text with p and q of degree i, P and Q of degree j.

    >>> numbered("p**2/2 + exp(q - Q)", 1, 2)
    'p1**2/2 + exp(q1 - q2)'
    """
    return _VARIABLE.sub(lambda found: found[0].lower() + str(j if found[0].isupper() else i), text)


def signed(text: str) -> str:
    """The text as it is added to others.

    >>> signed("-q") + signed("p")
    ' - q + p'
    """
    return f" - {text[1:]}" if text.startswith("-") else f" + {text}"
