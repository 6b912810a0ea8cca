"""The plane in which a region lies: that of one pair (q_i, p_i), through a point in 2n dimensions.

Its canonical area is then the integral of ω over it, and ∮ p·dq along its outline; the other
coordinates are the same for all its points, until a map moves them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.hamiltonians.coordinates import PLANE


@dataclass(frozen=True)
class Place:
    """The plane of one pair of coordinates through a point.

    `names`: q1 … qn, p1 … pn, the order of points' coordinates here; `point`: their values, of
    which those of the pair `index`, from 0, are the region's own.
    """

    names: tuple[str, ...] = PLANE[::-1]
    point: tuple[Fraction, ...] = (Fraction(0),) * 2
    index: int = 0

    @classmethod
    def from_point(cls, point: Mapping[str, Fraction], plane: int) -> "Place":
        """Return the plane through this point, p and q or p1 … qn by names.

        `plane` is i, from 1.
        """
        names = tuple(sorted(point, key=lambda name: (name[0] != "q", int(name[1:] or 1))))
        return cls(names, tuple(point[name] for name in names), plane - 1)

    @property
    def degrees(self) -> int:
        return len(self.names) // 2

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """The pairs (q1, p1) … (qn, pn)."""
        n = self.degrees
        return tuple(zip(self.names[:n], self.names[n:], strict=True))

    def embed(self, x: Any, y: Any, constant: Callable[[Fraction], Any]) -> tuple[Any, ...]:
        """Return points of the plane in all coordinates; `constant` repeats one number."""
        plane_axes = {self.index: x, self.degrees + self.index: y}
        return tuple(
            plane_axes[k] if k in plane_axes else constant(v) for k, v in enumerate(self.point)
        )


ITSELF = Place()
