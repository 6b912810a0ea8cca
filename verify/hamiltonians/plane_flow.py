"""The vector field of one H in the plane, as one of n degrees of freedom."""

from functools import cached_property

from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.canonical_field import Flow
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.vector_field import VectorField


class PlaneFlow(Flow):
    """f = (−H_q, H_p)."""

    names = PLANE

    def __init__(self, field: VectorField) -> None:
        self.field = field

    @property
    def ring(self) -> Ring:
        """The field's."""
        return self.field.ring

    @cached_property
    def slopes(self) -> tuple[Poly, ...]:
        """−H_q and H_p."""
        return -self.field.h_q, self.field.h_p

    def power(self, n: int) -> tuple[Poly, ...]:
        """Xⁿz, which the field keeps."""
        return self.field.power("p", n), self.field.power("q", n)
