"""A shape carried by a scheme's steps or by the exact flow: its areas, the mean of Λ, distances.

The relative change of the region's area is measured twice, by the area inside its image
(`verify.studies.regions.area`) and as the mean of Λ over it (`verify.studies.regions.mean_lambda`),
which by the change of variables are the same number. In n degrees of freedom the area is that of ω,
and the mean that of W's entry in the region's plane: by Stokes' theorem they are the same. A probe
whose own error is not far below the change is no result: float64 then gives way to more digits, and
where these do not do either, the image says so.
"""

import contextlib
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isfinite
from typing import Any

import numpy as np

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal, known_text, text, upper
from verify.arithmetic.number_system import UnsupportedError
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.times_on_the_way import first_fault
from verify.kernels.many_points import LeftRangeError
from verify.kernels.step.computation import step_map_of
from verify.prose import Number, Prose, prose, read_prose
from verify.scenes.results.regions import EXACT_FLOW, CarriedOutline, FlowImage, Projection
from verify.scenes.shapes.outline import Outline, Shape
from verify.structures import AREA, SYMPLECTIC
from verify.studies.regions.area import Goal, Measured, NoAreaError, Probe
from verify.studies.regions.mean_lambda import mean_over, middle_of
from verify.studies.regions.place import ITSELF, Place
from verify.studies.regions.point_carriers import (
    ExactFlowCarrier,
    FloatCarrier,
    SchemeCarrier,
    WideCarrier,
    distance_from_exact,
    smaller_than_one,
)
from verify.studies.regions.polyline import dense, to_draw
from verify.studies.regions.polyline import text as points_text

BELOW = 100  # how many times the probe's error is to be below the change of area
_MORE_DIGITS = 33
_FLOAT_DIGITS = 17
_DRAWN_POINTS = 20_000  # of a curve before it is thinned
_SHOWN = 12  # significant digits at most
_LOST = 7  # digits
# Of the region where the map changes area, and where it does not, and of the outlines inside it.
_PART = Fraction(1, 10**4)  # of the change
_CHANGED = Goal(_PART, Fraction(1, 10**14))
_UNCHANGED = Goal(change=Fraction(0), area=Fraction(1, 10**9))
_DETAIL = Goal(change=Fraction(1, 100), area=Fraction(1, 10**5))


@dataclass(frozen=True)
class _OutlineImage:
    """One outline under the map, in float64: its panels' nodes before and after."""

    outline: Outline
    measured: Measured
    before: list[tuple[np.ndarray, ...]]
    after: list[tuple[np.ndarray, ...]]
    place: Place

    def curve(self, index: int) -> np.ndarray:
        """The image in the plane (q_k, p_k), k − 1 = index: points (n, 2)."""
        n = self.place.degrees
        return dense([(z[index], z[n + index]) for z in self.after], _DRAWN_POINTS)[0]


@dataclass(frozen=True)
class _Carrying:
    """A map, the name of a scheme or EXACT_FLOW, that is applied so many times."""

    hamiltonian: Hamiltonian
    map: str
    step_size: Fraction
    steps: int
    t0: Fraction
    place: Place

    @property
    def time(self) -> Fraction:
        return self.step_size * self.steps

    @cached_property
    def preserves_area(self) -> bool:
        if self.map == EXACT_FLOW:
            return True
        return step_map_of(self.hamiltonian, self.map).preserves_area


def carry(
    hamiltonian: Hamiltonian,
    map_name: str,
    shape: Shape,
    *,
    step_size: Fraction,
    steps: int,
    digits: int,
    mean_lambda: bool,
    distance: bool,
    t0: Fraction | None = None,
    place: Place = ITSELF,
) -> FlowImage:
    """The image of the shape by so many steps of a scheme, or by the exact flow (EXACT_FLOW), from
    t0 on where H depends on time; in n degrees of freedom of one in the plane of `place`.

    At least so many digits are worked with. `mean_lambda`: the mean of Λ over the region, too;
    `distance`: how far its outlines are from the exact ones. `problem` says why there is no image.
    """
    begun = time.perf_counter()
    by = _Carrying(hamiltonian, map_name, step_size, steps, t0 or Fraction(0), place)
    kept = by.preserves_area
    found: dict[str, Any] = {}
    try:
        _check_smooth(by)
        with np.errstate(all="ignore"):  # what is not finite is looked for
            carried, plane = _measured(by, shape, digits)
            found = _areas(carried, plane, kept)
            if mean_lambda and not kept and not found["problem"]:
                found |= _mean(by, carried[0])
            if distance:
                with contextlib.suppress(NoFlowError):  # the area is known all the same
                    found |= _distance(by, carried)
    except (LeftRangeError, NoFlowError, NoAreaError) as error:
        found = {"problem": error.said if isinstance(error, NoFlowError) else prose(str(error))}
    return FlowImage(
        map=map_name,
        steps=steps,
        time=text(by.time),
        area_preserving=kept,
        seconds=time.perf_counter() - begun,
        **found,
    )


def _check_smooth(by: _Carrying) -> None:
    """NoFlowError where H is not smooth at some time on the way, which all points would meet."""
    step, words = first_fault(by.hamiltonian, by.t0, by.step_size, by.steps)
    if words:
        begin = text(by.t0 + step * by.step_size)
        reason = (
            f"at step {step + 1}, from t = `{begin}` on, H is not smooth; it is where `{words}`"
        )
        raise NoFlowError(reason)


# -- areas ----------------------------------------------------------------------------------------


def _measured(
    by: _Carrying, shape: Shape, digits: int
) -> tuple[list[_OutlineImage], SchemeCarrier | ExactFlowCarrier]:
    """All outlines, in the arithmetic that tells the region's change from the probe's error."""
    smaller, kept, place = smaller_than_one(shape.outlines[0]), by.preserves_area, by.place
    if by.map == EXACT_FLOW:
        exact = ExactFlowCarrier(by.hamiltonian, by.time, by.t0, smaller, place)
        return _all(shape, exact, _UNCHANGED), exact
    given = by.hamiltonian, by.map, by.step_size, by.steps, by.t0
    if digits <= _FLOAT_DIGITS:
        with contextlib.suppress(NoAreaError):  # its points may all be one in float64
            floats = FloatCarrier(*given, smaller, place)
            carried = _all(shape, floats, _UNCHANGED if kept else _CHANGED)
            measured = carried[0].measured
            if kept or _is_sharp(measured) or _is_unresolved(measured):
                return carried, floats
    digits = max(digits, _MORE_DIGITS)
    goal = _unchanged(digits) if kept else Goal(_PART, Fraction(100, 10**digits))
    *faster, last = (system.name for system in number_systems.automatic())
    for name in faster:
        with contextlib.suppress(UnsupportedError, LeftRangeError):
            wide = WideCarrier(*given, name, digits, smaller, place)
            return _all(shape, wide, goal), wide
    wide = WideCarrier(*given, last, digits, smaller, place)
    return _all(shape, wide, goal), wide


def _unchanged(digits: int) -> Goal:
    """As fine as the arithmetic can tell, with some digits for what shear does to rounding."""
    return Goal(Fraction(0), Fraction(1, 10 ** (digits - _LOST)))


def _all(shape: Shape, plane: SchemeCarrier | ExactFlowCarrier, goal: Goal) -> list[_OutlineImage]:
    goals = [goal, *[_DETAIL] * (len(shape.outlines) - 1)]
    found = []
    for outline, measured in zip(
        shape.outlines, Probe(shape.outlines, plane, goals).measure(), strict=True
    ):
        before = [plane.floats(panel.start) for panel in measured.panels]
        after = [plane.floats(panel.image) for panel in measured.panels]
        found.append(_OutlineImage(outline, measured, before, after, plane.place))
    return found


def _is_sharp(measured: Measured) -> bool:
    return BELOW * measured.error <= abs(measured.change)


def _is_unresolved(measured: Measured) -> bool:
    """Whether the curve is too long for the nodes there may be, which no digits mend."""
    return measured.exhausted and measured.truncated > BELOW * measured.rounded


def _areas(
    carried: Sequence[_OutlineImage], plane: SchemeCarrier | ExactFlowCarrier, kept: bool
) -> dict[str, Any]:
    region = carried[0].measured
    problem = _problem(region, kept)
    degrees = plane.place.degrees
    seen = [to_draw([each.curve(k) for each in carried]) for k in range(degrees)]
    curves = zip(*seen, strict=True)
    change, error = _shown(region.change, region.error)
    return {
        "problem": problem,
        "area_change": None if problem else change,
        "probe_error": decimal(region.error, 2) if problem else error,
        "arithmetic": plane.name,
        "digits": plane.digits,
        "method": plane.method,
        "outlines": tuple(map(_outline, carried, curves)),
    }


def _problem(region: Measured, kept: bool) -> Prose:
    """Why what was measured tells nothing; empty where it does."""
    if not kept and not _is_sharp(region):
        return read_prose(
            f"the probe's error `{decimal(region.error, 2)}` is not {BELOW} times below the change "
            f"of area `{decimal(region.change, 2)}`"
        )
    if BELOW * region.error > max(Fraction(1), abs(region.change)):
        error = Number(decimal(region.error, 2))
        return prose("the image is not resolved: its area is known but for ", error)
    return Prose()


def _outline(carried: _OutlineImage, curves: Sequence[np.ndarray]) -> CarriedOutline:
    """`curves`: one for each plane (q_k, p_k)."""
    measured, place = carried.measured, carried.place
    area = abs(measured.area)  # of a curve that runs clockwise it has a sign
    change, error = _shown(measured.change, measured.error)
    return CarriedOutline(
        name=carried.outline.name,
        area=_shown(area, area * measured.error)[0],
        area_change=change,
        probe_error=error,
        nodes=measured.nodes,
        points=points_text(curves[place.index]),
        projections=tuple(_projections(measured, curves)) if place.degrees > 1 else (),
    )


def _projections(measured: Measured, curves: Sequence[np.ndarray]) -> Iterator[Projection]:
    for k, ((value, error), curve) in enumerate(zip(measured.parts, curves, strict=True)):
        area, bound = _shown(value, error)
        yield Projection(plane=k + 1, area=area, area_error=bound, points=points_text(curve))


def _shown(value: Fraction, error: Fraction) -> tuple[str, str]:
    """The value with one digit more than is known, and its error with that of the text."""
    shown = known_text(value, error / 10, _SHOWN)
    return shown, upper(error + abs(value - Fraction(shown)))


# -- beside the areas -----------------------------------------------------------------------------


def _mean(by: _Carrying, region: _OutlineImage) -> dict[str, Any]:
    """The mean of Λ, or of W, over the region; nothing where the map is not defined on all rays to
    it."""
    given = by.hamiltonian, by.map, by.step_size, by.steps, by.t0, by.place
    try:
        found = mean_over(region.outline, middle_of(region.outline), *given)
    except LeftRangeError:
        return {}
    if not (isfinite(found.value) and isfinite(found.error)):  # areas below float64's range
        return {}
    value, error = Fraction(found.value), Fraction(found.error)
    agree = abs(value - region.measured.change) <= error + region.measured.error
    shown, bound = _shown(value, error)
    name = {AREA: "mean_lambda", SYMPLECTIC: "mean_defect"}[by.hamiltonian.structure]
    return {name: shown, f"{name}_error": bound, "agree": agree}


def _distance(by: _Carrying, carried: Sequence[_OutlineImage]) -> dict[str, Any]:
    """How far the outlines are from their images by the exact flow; nothing where too few points of
    the region's are known to tell even its area. Raises NoFlowError."""
    region = carried[0].measured
    if region.truncated > max(Fraction(1), abs(region.change)):
        return {}
    pairs = [(each.before, each.after) for each in carried]
    found = distance_from_exact(by.hamiltonian, by.time, by.t0, pairs)
    if found is None:
        return {}
    shown, told = _shown(*found)
    return {"distance": shown, "distance_error": told}
