"""Areas of the images of regions by a map, measured far more finely than the map changes them.

In n degrees of freedom the area is that of ω, the sum of those of the projections to the planes
(q_k, p_k), with their signs: ∮ p·dq.

A curve is cut into Gauss–Legendre panels (`verify.studies.regions.panels`). Each panel is measured
whole and in halves. The result takes the areas of the halves; their difference from the whole
panel's estimates the error of the whole, and so bounds that of the halves by far. If shear has
stretched the curve so that the difference matters, the halves are cut again. Rounding is measured
too: points of the halves are carried once more in finer arithmetic, and the panels' differences are
added without their signs. All curves are carried together.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import groupby, pairwise

import numpy as np

from verify.scenes.shapes.outline import Outline
from verify.studies.regions.panels import (
    NODES,
    Panel,
    PanelFamily,
    PanelPart,
    Points,
    Rule,
    nodes_between,
    rule,
    split_by_panel,
)
from verify.studies.regions.point_carriers import PointCarrier

FIRST_PANELS = 8  # the least number of panels that an outline is first cut into
MOST_NODES = 120_000
_MOST_ROUNDS = 24
_LEAST_REDUCTION = 2  # halving reduces truncation at least by this factor, and rounding does not


class NoAreaError(Exception):
    """A curve whose area cannot be distinguished from 0, so that its change has no meaning."""


@dataclass(frozen=True)
class Goal:
    """The greatest error of the quadrature, relative to the change of area or to the area.

    It is allowed the greater of the two, so that a change of 0 is not followed into rounding.
    """

    change: Fraction
    area: Fraction


@dataclass(frozen=True)
class MeasuredArea:
    """The area inside a curve and its relative change by a map, with a bound of the change's error.

    `truncation_error` and `rounding_error` are the parts of `error`: the quadrature's and the
    arithmetic's. `parts`: the image's area in each plane (q_k, p_k), by the area before, and its
    error. `panels` are the halves in their order along the curve. `exhausted`: the goals were not
    reached with as many nodes as there may be.
    """

    area: Fraction
    change: Fraction
    truncation_error: Fraction
    rounding_error: Fraction
    panels: tuple[Panel, ...]
    exhausted: bool
    parts: tuple[tuple[Fraction, Fraction], ...]

    @property
    def error(self) -> Fraction:
        """The bound of the error of `change`."""
        return self.truncation_error + self.rounding_error

    @property
    def nodes(self) -> int:
        """The number of points of the curve that were carried."""
        return NODES * len(self.panels)


class Probe:
    """A measurement of outlines by one carrier, each to its goal."""

    def __init__(
        self, outlines: Sequence[Outline], carrier: PointCarrier, goals: Sequence[Goal]
    ) -> None:
        self.outlines, self.carrier, self.goals = outlines, carrier, goals
        self.rule: Rule = rule(carrier.bits + 24)
        self.unit = Fraction(1, 2 ** (2 * carrier.grid + self.rule.bits))

    def measure(self) -> list[MeasuredArea]:
        """Cut panels until the errors are small enough, or no cut makes them smaller.

        Raises NoAreaError, and what the carrier's maps raise.
        """
        parts: list[PanelPart] = []
        for index, outline in enumerate(self.outlines):
            count = -(-FIRST_PANELS // len(outline.arcs))
            ends = [Fraction(k, count) for k in range(count + 1)]
            for arc in range(len(outline.arcs)):
                parts += [(index, arc, a, b) for a, b in pairwise(ends)]
        families = self._families(self._panels(parts))
        for index in range(len(self.outlines)):
            curve_families = self._select_outline(families, index)
            unsure = sum(family.unsure for family in curve_families)
            if unsure <= self._negligible_area(curve_families):
                # A goal relative to an area of 0 would be pursued in vain.
                self._check_area(curve_families)
        cut = self._select_to_cut(families)
        for _ in range(_MOST_ROUNDS):
            if not cut or NODES * 2 * (len(families) + len(cut)) > MOST_NODES:
                break
            families = self._cut(families, cut)
            cut = self._select_to_cut(families)
        rounding = self._roundings(families)
        return [
            self._build_result(self._select_outline(families, i), rounding[i], bool(cut))
            for i in range(len(self.outlines))
        ]

    # -- panels -------------------------------------------------------------------------------

    def _panels(self, parts: Sequence[PanelPart]) -> list[Panel]:
        starts = self._starts(parts)
        images = self._images(starts, self.carrier.images)
        areas = self._areas(starts), self._areas(images)
        return [
            Panel(*part, start, image, sum(before), after)
            for part, start, image, before, after in zip(parts, starts, images, *areas, strict=True)
        ]

    def _starts(self, parts: Sequence[PanelPart]) -> list[Points]:
        """Return the nodes of each part, those of one arc in one call."""
        points_of_part: dict[PanelPart, Points] = {}
        for (index, arc), group in groupby(sorted(parts), lambda part: part[:2]):
            group_parts = list(group)
            nodes = [s for _, _, a, b in group_parts for s in nodes_between(self.rule.bits, a, b)]
            points = self.carrier.points(self.outlines[index], arc, nodes)
            points_of_part |= zip(group_parts, split_by_panel(points), strict=True)
        return [points_of_part[part] for part in parts]

    def _images(self, starts: Sequence[Points], carry: Callable[..., Points]) -> list[Points]:
        """Map all points in one call."""
        return split_by_panel(carry(*(np.concatenate(z) for z in zip(*starts, strict=True))))

    def _areas(self, points: Sequence[Points]) -> list[tuple[int, ...]]:
        """Return each panel's area in each plane (q_k, p_k)."""
        axes = [
            self.carrier.whole(np.concatenate(z)).reshape(-1, NODES)
            for z in zip(*points, strict=True)
        ]
        n = len(axes) // 2
        pairs = zip(axes[:n], axes[n:], strict=True)
        return list(zip(*(self.rule.areas(x, y) for x, y in pairs), strict=True))

    def _families(self, panels: Sequence[Panel]) -> list[PanelFamily]:
        halves = self._panels([half for panel in panels for half in panel.halves])
        pairs = zip(halves[::2], halves[1::2], strict=True)
        families = []
        for panel, (left, right) in zip(panels, pairs, strict=True):
            unsure = abs(panel.before - left.before - right.before)
            difference = unsure + abs(panel.after - left.after - right.after)
            triples = zip(panel.parts, left.parts, right.parts, strict=True)
            parts = tuple(abs(x - y - z) for x, y, z in triples)
            families.append(PanelFamily((left, right), difference, unsure, parts))
        return families

    # -- which panels to cut ------------------------------------------------------------------

    @staticmethod
    def _select_outline(families: Sequence[PanelFamily], index: int) -> list[PanelFamily]:
        return [family for family in families if family.halves[0].outline == index]

    def _select_to_cut(self, families: Sequence[PanelFamily]) -> set[int]:
        """Return the ids of families whose difference exceeds their share of the tolerance."""
        selected: list[PanelFamily] = []
        for index, goal in enumerate(self.goals):
            curve_families = self._select_outline(families, index)
            change = abs(sum(family.change for family in curve_families))
            tolerance = max(goal.change * change, goal.area * self._size(curve_families))
            share = tolerance / (2 * len(curve_families))
            selected += [f for f in curve_families if f.difference > share and not f.stuck]
        return set(map(id, selected))

    @staticmethod
    def _size(families: Sequence[PanelFamily]) -> int:
        return abs(sum(family.before for family in families))

    def _cut(self, families: Sequence[PanelFamily], cut: set[int]) -> list[PanelFamily]:
        parents = [half for family in families if id(family) in cut for half in family.halves]
        halves = iter(self._families(parents))
        sizes = [self._size(self._select_outline(families, i)) for i in range(len(self.outlines))]
        result: list[PanelFamily] = []
        for family in families:
            if id(family) not in cut:
                result.append(family)
                continue
            children = [next(halves), next(halves)]
            is_smaller = _LEAST_REDUCTION * sum(f.difference for f in children) <= family.difference
            # A difference that halving hardly reduces, far below the area, comes from rounding: to
            # cut on would never end.
            noise = sizes[family.halves[0].outline] >> (self.carrier.bits // 2)
            if not is_smaller and family.difference < noise:
                children = [replace(f, stuck=True) for f in children]
            result += children
        return result

    # -- the result ---------------------------------------------------------------------------

    def _build_result(
        self, families: Sequence[PanelFamily], rounding: int, exhausted: bool
    ) -> MeasuredArea:
        panels = tuple(half for family in families for half in family.halves)
        area, size = sum(panel.before for panel in panels), self._size(families)
        self._check_area(families)
        rounding_error = Fraction(rounding + self._rule_rounding(panels), size)
        sums = zip(*(panel.parts for panel in panels), strict=True)
        differences = zip(*(family.parts for family in families), strict=True)
        return MeasuredArea(
            area=area * self.unit,
            change=Fraction(sum(panel.change for panel in panels), area),
            truncation_error=Fraction(sum(family.difference for family in families), size),
            rounding_error=rounding_error,
            panels=panels,
            exhausted=exhausted,
            parts=tuple(
                (Fraction(sum(x), area), Fraction(sum(y), size) + rounding_error)
                for x, y in zip(sums, differences, strict=True)
            ),
        )

    def _negligible_area(self, families: Sequence[PanelFamily]) -> int:
        """Return an area that rounding cannot distinguish from 0.

        It is relative to the areas that the curve's panels sweep, added without signs.
        """
        swept = sum(abs(panel.before) for family in families for panel in family.halves)
        return swept >> (self.carrier.bits // 2)

    def _check_area(self, families: Sequence[PanelFamily]) -> None:
        """Raise NoAreaError for a curve that bounds no area, as a figure of eight may."""
        if self._size(families) <= self._negligible_area(families):
            name = self.outlines[families[0].halves[0].outline].name
            raise NoAreaError(f"the outline {name} bounds no area that is told from 0")

    def _roundings(self, families: Sequence[PanelFamily]) -> list[int]:
        """Return the rounding error of each curve's area, in units of the panels' areas.

        It is the sum of the panels' absolute differences from finer arithmetic, in all planes. If
        the carrier has a bound of the images' error, it is that bound times the image's length.
        """
        panels_of_curves = [
            [h for f in self._select_outline(families, i) for h in f.halves]
            for i in range(len(self.goals))
        ]
        if self.carrier.radius is not None:
            return [
                round(self.carrier.radius * self._length(x) / self.unit) for x in panels_of_curves
            ]
        sampled = self.carrier.sampled
        samples = [panels[:: max(1, len(panels) // sampled)] for panels in panels_of_curves]
        flat = [panel for panels in samples for panel in panels]
        areas = iter(self._areas(self._images([p.start for p in flat], self.carrier.finer)))
        differences = [
            sum(abs(x - y) for p in panels for x, y in zip(next(areas), p.parts, strict=True))
            for panels in samples
        ]
        # A sample of every k-th panel stands for all of them: its sum is scaled up, and doubled.
        return [
            2 * -(-x * len(panels) // len(sample))
            for x, panels, sample in zip(differences, panels_of_curves, samples, strict=True)
        ]

    def _length(self, panels: Sequence[Panel]) -> Fraction:
        """Return the sum of |dz| of all coordinates along the image's nodes, and a quarter more."""
        images = zip(*(panel.image for panel in panels), strict=True)
        axes = [np.concatenate([self.carrier.whole(z) for z in axis]) for axis in images]
        steps = sum(int(abs(np.diff(axis)).sum()) for axis in axes)
        return Fraction(steps * 5 // 4, 2**self.carrier.grid)

    def _rule_rounding(self, panels: Sequence[Panel]) -> int:
        """Return a bound of the error that the rounding of the rule's matrix makes, in units."""
        largest = max(int(abs(self.carrier.whole(x)).max()) for p in panels for x in p.image)
        return len(panels[0].parts) * len(panels) * NODES**2 * largest**2
