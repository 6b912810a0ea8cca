"""The area that a map gives to the region inside a curve, measured far more finely than it changes.

The curve is cut into Gauss–Legendre panels (`verify.panels`). Each is measured whole and in halves;
the difference is the error of the whole, and so a bound, and by far, for that of the halves, whose
areas count. Where shear has stretched the curve so that the difference matters, the halves are cut
again. Rounding is measured too: the halves' points are carried once more in finer arithmetic, and
the panels' differences count without their signs.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

import numpy as np

from verify.outline import Outline
from verify.panels import NODES, Rule, rule

FIRST_PANELS = 8  # of an outline, at least
MOST_NODES = 120_000
_MOST_ROUNDS = 24
_BELOW = 10_000  # the quadrature's error is to be so many times below the change of area
_STUCK = 2  # a difference that halving does not make smaller by this factor is rounding's


class Plane(Protocol):
    """Points in one number system, and a map of them."""

    bits: int  # about so many are right after the point

    def points(self, outline: Outline, arc: int, s: Sequence[Fraction]) -> tuple[Any, Any]:
        """Sequences of x and y of an arc's points."""

    def carried(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Their images."""

    sampled: int  # panels that are carried in finer arithmetic
    radius: Fraction | None  # a bound of the images' error, where that is known otherwise

    def finer(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Their images in finer arithmetic."""

    def whole(self, x: Any) -> np.ndarray:
        """2^grid x, rounded to whole numbers; an array of int."""

    grid: int


@dataclass(frozen=True)
class Panel:
    """A part of an arc with its points, and the points' images."""

    arc: int
    left: Fraction
    right: Fraction
    start: tuple[Any, Any]
    image: tuple[Any, Any]
    before: int  # area swept, in units of the plane's grid and of the rule
    after: int

    @property
    def change(self) -> int:
        return self.after - self.before


@dataclass
class Family:
    """A panel in halves, with how much they differ from the whole."""

    halves: tuple[Panel, Panel]
    difference: int
    stuck: bool = False

    @property
    def change(self) -> int:
        return self.halves[0].change + self.halves[1].change


@dataclass(frozen=True)
class Measured:
    """The area inside a curve and its relative change by a map, with a bound of the change's error.

    `truncated` and `rounded` are the parts of `error`: the quadrature's and the arithmetic's.
    `panels` are the halves in their order along the curve.
    """

    area: Fraction
    change: Fraction
    truncated: Fraction
    rounded: Fraction
    panels: tuple[Panel, ...]

    @property
    def error(self) -> Fraction:
        return self.truncated + self.rounded

    @property
    def nodes(self) -> int:
        return NODES * len(self.panels)


class Probe:
    """Measures one outline in one plane."""

    def __init__(self, outline: Outline, plane: Plane) -> None:
        self.outline, self.plane = outline, plane
        self.rule: Rule = rule(plane.bits + 24)
        self.unit = Fraction(1, 2 ** (2 * plane.grid + self.rule.bits))

    def measure(self) -> Measured:
        """Cuts until the error is far below the change, or no cut makes it smaller."""
        count = -(-FIRST_PANELS // len(self.outline.arcs))
        ends = [
            (arc, Fraction(k, count), Fraction(k + 1, count))
            for arc in range(len(self.outline.arcs))
            for k in range(count)
        ]
        families = self._families(self._panels(ends))
        for _ in range(_MOST_ROUNDS):
            cut = self._to_cut(families)
            if not cut or NODES * 2 * (len(families) + len(cut)) > MOST_NODES:
                break
            families = self._cut(families, cut)
        return self._measured(families)

    # -- panels -------------------------------------------------------------------------------

    def _panels(self, ends: Sequence[tuple[int, Fraction, Fraction]]) -> list[Panel]:
        starts = [
            self.plane.points(self.outline, arc, [a + (b - a) * s for s in self.rule.nodes])
            for arc, a, b in ends
        ]
        images = self._images(starts, self.plane.carried)
        areas = self._areas(starts), self._areas(images)
        return [
            Panel(*end, start, image, before, after)
            for end, start, image, before, after in zip(ends, starts, images, *areas, strict=True)
        ]

    def _images(
        self, starts: Sequence[tuple[Any, Any]], carry: Callable[[Any, Any], tuple[Any, Any]]
    ) -> list[tuple[Any, Any]]:
        """All points in one call."""
        x, y = carry(*(np.concatenate([start[i] for start in starts]) for i in (0, 1)))
        cut = [slice(i, i + NODES) for i in range(0, len(x), NODES)]
        return [(x[part], y[part]) for part in cut]

    def _areas(self, points: Sequence[tuple[Any, Any]]) -> list[int]:
        x, y = (
            self.plane.whole(np.concatenate([each[i] for each in points])).reshape(-1, NODES)
            for i in (0, 1)
        )
        return list(self.rule.areas(x, y))

    def _families(self, panels: Sequence[Panel]) -> list[Family]:
        middles = [(p.left + p.right) / 2 for p in panels]
        ends = [
            (p.arc, *part)
            for p, m in zip(panels, middles, strict=True)
            for part in ((p.left, m), (m, p.right))
        ]
        halves = self._panels(ends)
        return [
            Family(both, _difference(p, both))
            for p, both in zip(panels, zip(halves[::2], halves[1::2], strict=True), strict=True)
        ]

    # -- where to cut -------------------------------------------------------------------------

    def _to_cut(self, families: Sequence[Family]) -> set[int]:
        """The families whose difference is more than their share of what is allowed."""
        allowed = max(abs(sum(f.change for f in families)) // _BELOW, self._least(families))
        share = allowed // (2 * len(families))
        return {i for i, f in enumerate(families) if f.difference > share and not f.stuck}

    def _least(self, families: Sequence[Family]) -> int:
        """What no quadrature sees: the last bits of the plane."""
        area = abs(sum(h.before for f in families for h in f.halves))
        return int(area) >> (self.plane.bits - 4)

    def _cut(self, families: Sequence[Family], cut: set[int]) -> list[Family]:
        parents = [half for i in sorted(cut) for half in families[i].halves]
        made = iter(self._families(parents))
        result: list[Family] = []
        for i, family in enumerate(families):
            if i not in cut:
                result.append(family)
                continue
            two = [next(made), next(made)]
            if _STUCK * sum(f.difference for f in two) > family.difference and self._is_noise(
                family, families
            ):
                two = [Family(f.halves, f.difference, stuck=True) for f in two]
            result += two
        return result

    def _is_noise(self, family: Family, families: Sequence[Family]) -> bool:
        """Whether a difference is small enough to be rounding's at all."""
        area = abs(sum(h.before for f in families for h in f.halves))
        return family.difference < int(area) >> (self.plane.bits // 2)

    # -- the result ---------------------------------------------------------------------------

    def _measured(self, families: Sequence[Family]) -> Measured:
        panels = tuple(half for f in families for half in f.halves)
        area = sum(p.before for p in panels)
        change = sum(p.change for p in panels)
        truncated = sum(f.difference for f in families)
        size = abs(area)
        return Measured(
            area=area * self.unit,
            change=Fraction(change, area),
            truncated=Fraction(truncated, size),
            rounded=Fraction(self._rounding(panels), size) + self._floor(panels, size),
            panels=panels,
        )

    def _rounding(self, panels: Sequence[Panel]) -> int:
        """Differences of the panels' areas from those in finer arithmetic, without their signs.

        Where the images' error is known, that times the length of the image.
        """
        if self.plane.radius is not None:
            return round(self.plane.radius * self._length(panels) / self.unit)
        some = panels[:: max(1, len(panels) // self.plane.sampled)]
        starts = [p.start for p in some]
        images = self._images(starts, self.plane.finer)
        apart = sum(abs(a - p.after) for a, p in zip(self._areas(images), some, strict=True))
        return 2 * -(-apart * len(panels) // len(some))

    def _length(self, panels: Sequence[Panel]) -> Fraction:
        """At least the sum of |dx| + |dy| along the image, by its nodes."""
        grid = [[self.plane.whole(p.image[i]) for p in panels] for i in (0, 1)]
        steps = (abs(np.diff(np.concatenate(axis))).sum() for axis in grid)
        return Fraction(int(sum(steps)) * 5 // 4, 2**self.plane.grid)

    def _floor(self, panels: Sequence[Panel], size: int) -> Fraction:
        """The rounding of the rule's numbers."""
        largest = max(int(abs(self.plane.whole(x)).max()) for p in panels for x in p.image)
        return Fraction(len(panels) * NODES**2 * largest**2, size)


def _difference(whole: Panel, halves: tuple[Panel, Panel]) -> int:
    return abs(whole.before - halves[0].before - halves[1].before) + abs(
        whole.after - halves[0].after - halves[1].after
    )
