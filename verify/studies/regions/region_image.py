"""A shape carried by a scheme's steps or by the exact flow: its areas, the mean of Λ, distances.

The relative change of the region's area is measured twice: by the area inside its image
(`verify.studies.regions.region_area`), and as the mean of Λ, the cumulative area error, over it
(`verify.studies.regions.mean_lambda`). By the change of variables they are the same number. In n
degrees of freedom the area is that of ω, and the mean that of W's entry in the region's plane: by
Stokes' theorem they are the same. The area's measurement, the probe, is no result unless its error
is far below the change: it is repeated with more digits, and the result says so if they do not
suffice.
"""

import contextlib
import time
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isfinite
from typing import Any

import numpy as np

from verify import arithmetic as number_systems
from verify.arithmetic.exact import decimal, text
from verify.arithmetic.number_system import UnsupportedError
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import find_first_fault
from verify.kernels.many_points import LeftRangeError
from verify.kernels.step.computation import step_map_of
from verify.prose import Number, Prose, prose, read_prose
from verify.scenes.results.regions import EXACT_FLOW, FlowImage
from verify.scenes.shapes.outline import Shape
from verify.structures import AREA, SYMPLECTIC
from verify.studies.regions import point_carriers
from verify.studies.regions.mean_lambda import find_middle, mean_over
from verify.studies.regions.outline_images import (
    OutlineImage,
    build_outline,
    distance_from_exact,
    format_with_error,
)
from verify.studies.regions.polyline import thin_for_drawing
from verify.studies.regions.region_area import Goal, MeasuredArea, NoAreaError, Probe

BELOW = 100  # the change of area must be this many times the probe's error
_WIDE_DIGITS = 33  # the least digits of the arithmetic that replaces float64
_FLOAT_DIGITS = 17
_SHEAR_DIGITS = 7  # digits that rounding under shear may take from the area
_CHANGE_TOLERANCE = Fraction(1, 10**4)  # relative to the change of area
# Goals in float64: for the region if the map changes areas and if it does not, and for the outlines
# inside the region in any arithmetic.
_GOAL_IF_CHANGED = Goal(_CHANGE_TOLERANCE, Fraction(1, 10**14))
_GOAL_IF_UNCHANGED = Goal(change=Fraction(0), area=Fraction(1, 10**9))
_GOAL_INSIDE = Goal(change=Fraction(1, 100), area=Fraction(1, 10**5))


@dataclass(frozen=True)
class _Iterate:
    """A map, by the name of a scheme or EXACT_FLOW, that is applied so many times."""

    hamiltonian: Hamiltonian
    map: str
    step_size: Fraction
    steps: int
    t0: Fraction
    plane: point_carriers.RegionPlane

    @property
    def arguments(self) -> tuple[Hamiltonian, str, Fraction, int, Fraction]:
        """The arguments that every way to apply the map takes."""
        return self.hamiltonian, self.map, self.step_size, self.steps, self.t0

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
    plane: point_carriers.RegionPlane = point_carriers.QP_PLANE,
) -> FlowImage:
    """Return the image of the shape by `steps` steps of the scheme `map_name`, or by EXACT_FLOW.

    If H depends on time the map starts at t0; in n degrees of freedom the shape lies in `plane`.
    The arithmetic has at least `digits` digits. `mean_lambda`: compute the mean of Λ over the
    region, too; `distance`: compute the distance of its outlines' images from the exact ones. In
    the result `problem` says why there is no image, or none whose area is known.
    """
    start_time = time.perf_counter()
    iterate = _Iterate(hamiltonian, map_name, step_size, steps, t0 or Fraction(0), plane)
    preserves_area = iterate.preserves_area
    fields: dict[str, Any] = {}
    try:
        _check_smooth(iterate)
        with np.errstate(all="ignore"):  # non-finite numbers are checked for
            images, carrier = _measure_outlines(iterate, shape, digits)
            fields = _area_fields(images, carrier, preserves_area)
            if mean_lambda and not preserves_area and not fields["problem"]:
                fields |= _mean_fields(iterate, images[0])
            if distance:
                with contextlib.suppress(NoFlowError):  # the area does not need the exact flow
                    fields |= _distance_fields(iterate, images)
    except (LeftRangeError, NoFlowError, NoAreaError) as error:
        fields = {"problem": error.reason if isinstance(error, NoFlowError) else prose(str(error))}
    return FlowImage(
        map=map_name,
        steps=steps,
        time=text(iterate.time),
        area_preserving=preserves_area,
        seconds=time.perf_counter() - start_time,
        **fields,
    )


def _check_smooth(iterate: _Iterate) -> None:
    """Raise NoFlowError if H is not smooth at some time on the way, which all points would meet."""
    fault = find_first_fault(iterate.hamiltonian, iterate.t0, iterate.step_size, iterate.steps)
    if fault is not None:
        begin = text(iterate.t0 + fault.step * iterate.step_size)
        interval_text = f"at step {fault.step + 1}, from t = `{begin}` on"
        raise NoFlowError(f"{interval_text}, H is not smooth; it is where `{fault.condition}`")


# -- areas ----------------------------------------------------------------------------------------


def _measure_outlines(
    iterate: _Iterate, shape: Shape, digits: int
) -> tuple[list[OutlineImage], point_carriers.SchemeCarrier | point_carriers.ExactFlowCarrier]:
    """Measure all outlines, in arithmetic fine enough for the region's change of area."""
    smaller = point_carriers.smaller_than_one(shape.outlines[0])
    preserves_area = iterate.preserves_area
    plane = iterate.plane
    if iterate.map == EXACT_FLOW:
        flow_carrier = point_carriers.ExactFlowCarrier(
            iterate.hamiltonian, iterate.time, iterate.t0, smaller, plane
        )
        return _carry_all(shape, flow_carrier, _GOAL_IF_UNCHANGED), flow_carrier
    arguments = iterate.arguments
    if digits <= _FLOAT_DIGITS:
        with contextlib.suppress(NoAreaError):  # in float64 a tiny outline may be one point
            floats = point_carriers.FloatCarrier(*arguments, smaller, plane)
            images = _carry_all(
                shape, floats, _GOAL_IF_UNCHANGED if preserves_area else _GOAL_IF_CHANGED
            )
            region = images[0].measured
            # float64 suffices where nothing changes or its error is far below the change; more
            # nodes, not more digits, would mend a curve that is too long.
            if preserves_area or _is_sharp(region) or _is_unresolved(region):
                return images, floats
    digits = max(digits, _WIDE_DIGITS)
    goal = (
        _goal_without_change(digits)
        if preserves_area
        else Goal(_CHANGE_TOLERANCE, Fraction(100, 10**digits))
    )
    *faster, last = (system.name for system in number_systems.automatic())
    for name in faster:
        # A fixed-point system may lack a function or the range; the last system has both.
        with contextlib.suppress(UnsupportedError, LeftRangeError):
            wide = point_carriers.WideCarrier(*arguments, name, digits, smaller, plane)
            return _carry_all(shape, wide, goal), wide
    wide = point_carriers.WideCarrier(*arguments, last, digits, smaller, plane)
    return _carry_all(shape, wide, goal), wide


def _goal_without_change(digits: int) -> Goal:
    """Return a goal relative to the area, with fewer digits than the arithmetic has.

    Rounding under shear may take the others.
    """
    return Goal(Fraction(0), Fraction(1, 10 ** (digits - _SHEAR_DIGITS)))


def _carry_all(
    shape: Shape,
    carrier: point_carriers.SchemeCarrier | point_carriers.ExactFlowCarrier,
    goal: Goal,
) -> list[OutlineImage]:
    goals = [goal, *[_GOAL_INSIDE] * (len(shape.outlines) - 1)]
    images = []
    for outline, area in zip(
        shape.outlines, Probe(shape.outlines, carrier, goals).measure(), strict=True
    ):
        before = [carrier.floats(panel.start) for panel in area.panels]
        after = [carrier.floats(panel.image) for panel in area.panels]
        images.append(OutlineImage(outline, area, before, after, carrier.plane))
    return images


def _is_sharp(region: MeasuredArea) -> bool:
    return BELOW * region.error <= abs(region.change)


def _is_unresolved(region: MeasuredArea) -> bool:
    """Return True if the curve is too long for the number of nodes, which no digits mend."""
    return region.exhausted and region.truncation_error > BELOW * region.rounding_error


def _area_fields(
    images: Sequence[OutlineImage],
    carrier: point_carriers.SchemeCarrier | point_carriers.ExactFlowCarrier,
    preserves_area: bool,
) -> dict[str, Any]:
    region = images[0].measured
    problem = _describe_problem(region, preserves_area)
    degrees = carrier.plane.degrees
    drawn_curves = [thin_for_drawing([image.curve(k) for image in images]) for k in range(degrees)]
    curves = zip(*drawn_curves, strict=True)
    change, error = format_with_error(region.change, region.error)
    return {
        "problem": problem,
        "area_change": None if problem else change,
        "probe_error": decimal(region.error, 2) if problem else error,
        "arithmetic": carrier.name,
        "digits": carrier.digits,
        "method": carrier.method,
        "outlines": tuple(map(build_outline, images, curves)),
    }


def _describe_problem(region: MeasuredArea, preserves_area: bool) -> Prose:
    """Describe why the measurement is no result; empty if it is one."""
    if not preserves_area and not _is_sharp(region):
        return read_prose(
            f"the probe's error `{decimal(region.error, 2)}` is not {BELOW} times below the change "
            f"of area `{decimal(region.change, 2)}`"
        )
    if BELOW * region.error > max(Fraction(1), abs(region.change)):
        error = Number(decimal(region.error, 2))
        return prose("the image is not resolved: its area is known but for ", error)
    return Prose()


# -- beside the areas -----------------------------------------------------------------------------


def _mean_fields(iterate: _Iterate, region: OutlineImage) -> dict[str, Any]:
    """Return the fields of the mean of Λ, or of W, over the region.

    There are none if the map is not defined on all rays from the region's centre to its outline.
    """
    arguments = *iterate.arguments, iterate.plane
    try:
        mean = mean_over(region.outline, find_middle(region.outline), *arguments)
    except LeftRangeError:
        return {}
    if not (isfinite(mean.value) and isfinite(mean.error)):  # areas below float64's range
        return {}
    value, error = Fraction(mean.value), Fraction(mean.error)
    agree = abs(value - region.measured.change) <= error + region.measured.error
    mean_text, bound = format_with_error(value, error)
    name = {AREA: "mean_lambda", SYMPLECTIC: "mean_defect"}[iterate.hamiltonian.structure]
    return {name: mean_text, f"{name}_error": bound, "agree": agree}


def _distance_fields(iterate: _Iterate, images: Sequence[OutlineImage]) -> dict[str, Any]:
    """Return the fields of the outlines' distance from their images by the exact flow.

    There are none if the image's area is not resolved, or the image is too far away for float64.
    Raises NoFlowError.
    """
    region = images[0].measured
    if region.truncation_error > max(Fraction(1), abs(region.change)):
        return {}
    distance = distance_from_exact(iterate.hamiltonian, iterate.time, iterate.t0, images)
    if distance is None:
        return {}
    distance_text, error_text = format_with_error(*distance)
    return {"distance": distance_text, "distance_error": error_text}
