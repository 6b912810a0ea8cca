"""What a probe asks of whoever carries points: see `verify.studies.regions.point_carriers`."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Protocol

import numpy as np

from verify.scenes.shapes.outline import Outline

Points = tuple[Any, ...]
"""q and p, or q1 … qn and p1 … pn: a sequence of each."""


class PointCarrier(Protocol):
    """Points in one number system, and a map of them."""

    bits: int  # about so many are right after the point
    grid: int  # 2^grid is what `whole` multiplies by
    sampled: int  # panels that are carried in finer arithmetic
    radius: Fraction | None  # a bound of the images' error, where that is known otherwise

    def points(self, outline: Outline, arc: int, s: Sequence[Fraction]) -> Points:
        """An arc's points."""

    def images(self, *points: Any) -> Points:
        """Their images."""

    def finer(self, *points: Any) -> Points:
        """Their images in finer arithmetic."""

    def whole(self, x: Any) -> np.ndarray:
        """2^grid x, rounded to whole numbers; an array of int."""
