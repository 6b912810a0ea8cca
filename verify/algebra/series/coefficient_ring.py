"""What power series and forms are made over: a ring of functions with derivatives.

`verify.algebra.ring.Ring` is one, in which zero is decided; the jets of every H are another, in
which zero is the zero polynomial.
"""

from collections.abc import Mapping
from fractions import Fraction
from typing import Protocol

from verify.algebra.generator import Poly
from verify.algebra.zero_test import Decision


class CoefficientRing(Protocol):
    """See the module's text."""

    @property
    def zero(self) -> Poly:
        """0."""

    @property
    def one(self) -> Poly:
        """1."""

    @property
    def places(self) -> Mapping[str, int]:
        """The variables by their names."""

    def reduce(self, x: Poly) -> Poly:
        """x in normal form."""

    def multiply(self, x: Poly, y: Poly) -> Poly:
        """The product in normal form."""

    def constant(self, value: Fraction) -> Poly:
        """A rational number as an element."""

    def variable(self, name: str) -> Poly:
        """A variable as an element."""

    def diff(self, x: Poly, name: str) -> Poly:
        """The partial derivative by a variable."""

    def decide(self, x: Poly) -> Decision:
        """Whether x is the zero function."""

    def vanishes(self, x: Poly) -> bool | None:
        """The same, without a witness."""

    def text(self, x: Poly) -> str:
        """x as a formula."""
