"""A shape carried by a scheme's steps or by the exact flow: its areas, the mean of Λ, distances.

The relative change of the region's area is measured twice, by the area inside its image
(`verify.area_probe`) and as the mean of Λ over it (`verify.region_mean`), which by the change of
variables are the same number. A probe whose own error is not far below the change is no result:
float64 then gives way to more digits, and where these do not do either, the image says so.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from verify.area_probe import Goal, Measured, Probe
from verify.exact import decimal, text
from verify.flow_results import EXACT_FLOW, CarriedOutline, FlowImage
from verify.hamiltonian import Hamiltonian
from verify.hausdorff import hausdorff
from verify.many_points import LeftError
from verify.outline import Outline, Shape
from verify.planes import ExactPlane, FloatPlane, SchemePlane, WidePlane
from verify.polyline import DRAWN, dense, thinned
from verify.polyline import text as points_text
from verify.proof.exact_flow import NoFlowError
from verify.region_mean import Mean, RegionMean
from verify.schemes import get
from verify.tasks import FlowTask

BELOW = 100  # how many times the probe's error is to be below the change of area
_MORE_DIGITS = 33
_FLOAT_DIGITS = 17
_DRAWN_POINTS = 20_000  # of a curve before it is thinned
_SHOWN = 12  # significant digits at most
_LOST = 7  # digits
# Of the region where the map changes area, and where it does not, and of the outlines inside it.
_CHANGED = Goal(change=Fraction(1, 10**4), area=Fraction(1, 10**14))
_UNCHANGED = Goal(change=Fraction(0), area=Fraction(1, 10**9))
_DETAIL = Goal(change=Fraction(1, 100), area=Fraction(1, 10**5))


@dataclass(frozen=True)
class _Carried:
    """One outline under the map, in float64: its panels' nodes before and after."""

    outline: Outline
    measured: Measured
    before: list[tuple[np.ndarray, np.ndarray]]
    after: list[tuple[np.ndarray, np.ndarray]]


def carry(hamiltonian: Hamiltonian, task: FlowTask) -> FlowImage:
    """The image of the task's shape; `problem` says why where there is none."""
    begun = time.perf_counter()
    span = task.step_size * task.steps
    exact = task.map == EXACT_FLOW
    preserves = True if exact else get(task.map).step_map(hamiltonian).preserves_area
    found: dict[str, Any] = {}
    try:
        carried, plane = _measured(hamiltonian, task, preserves)
        found = _areas(carried, plane, preserves)
        if task.mean_lambda and not preserves:
            found |= _mean(hamiltonian, task, carried[0])
        if task.distance:
            found |= _distance(hamiltonian, span, carried)
    except (LeftError, NoFlowError) as error:
        found = {"problem": str(error)}
    return FlowImage(
        map=task.map,
        steps=task.steps,
        time=text(span),
        area_preserving=preserves,
        seconds=time.perf_counter() - begun,
        **found,
    )


# -- areas ----------------------------------------------------------------------------------------


def _measured(
    hamiltonian: Hamiltonian, task: FlowTask, preserves: bool
) -> tuple[list[_Carried], SchemePlane | ExactPlane]:
    """All outlines, in the arithmetic that tells the region's change from the probe's error."""
    shape = task.shape.made()
    if task.map == EXACT_FLOW:
        exact = ExactPlane(hamiltonian, task.step_size * task.steps)
        return _all(shape, exact, _UNCHANGED), exact
    given = hamiltonian, task.map, task.step_size, task.steps
    if task.digits <= _FLOAT_DIGITS:
        floats = FloatPlane(*given)
        carried = _all(shape, floats, _UNCHANGED if preserves else _CHANGED)
        if preserves or _is_sharp(carried[0].measured):
            return carried, floats
    wide = WidePlane.of(*given, digits=max(task.digits, _MORE_DIGITS))
    return _all(shape, wide, _unchanged(wide.digits) if preserves else _CHANGED), wide


def _unchanged(digits: int) -> Goal:
    """As fine as the arithmetic can tell, with some digits for what shear does to rounding."""
    return Goal(Fraction(0), Fraction(1, 10 ** (digits - _LOST)))


def _all(shape: Shape, plane: SchemePlane | ExactPlane, goal: Goal) -> list[_Carried]:
    goals = [goal, *[_DETAIL] * (len(shape.outlines) - 1)]
    found = []
    for outline, measured in zip(
        shape.outlines, Probe(shape.outlines, plane, goals).measure(), strict=True
    ):
        before = [plane.floats(panel.start) for panel in measured.panels]
        after = [plane.floats(panel.image) for panel in measured.panels]
        found.append(_Carried(outline, measured, before, after))
    return found


def _is_sharp(measured: Measured) -> bool:
    return BELOW * measured.error <= abs(measured.change)


def _areas(
    carried: Sequence[_Carried], plane: SchemePlane | ExactPlane, preserves: bool
) -> dict[str, Any]:
    region = carried[0].measured
    problem = ""
    if not preserves and not _is_sharp(region):
        problem = (
            f"the probe's error {decimal(region.error, 2)} is not {BELOW} times below the change "
            f"of area {decimal(region.change, 2)}"
        )
    curves = [dense(each.after, _DRAWN_POINTS)[0] for each in carried]
    return {
        "problem": problem,
        "area_change": None if problem else _known(region.change, region.error),
        "probe_error": decimal(region.error, 2),
        "arithmetic": plane.name,
        "digits": plane.digits,
        "method": plane.method,
        "outlines": tuple(_outlines(carried, curves)),
    }


def _outlines(carried: Sequence[_Carried], curves: Sequence[np.ndarray]) -> list[CarriedOutline]:
    fine = _extent(curves) / DRAWN
    return [
        CarriedOutline(
            name=each.outline.name,
            area=_known(each.measured.area, each.measured.area * each.measured.error),
            area_change=_known(each.measured.change, each.measured.error),
            probe_error=decimal(each.measured.error, 2),
            nodes=each.measured.nodes,
            points=points_text(thinned(curve, fine)),
        )
        for each, curve in zip(carried, curves, strict=True)
    ]


def _extent(curves: Sequence[np.ndarray]) -> float:
    return float(np.ptp(np.concatenate(curves), axis=0).max())


def _known(value: Fraction, error: Fraction) -> str:
    """The digits that are known, the last by one unit or so; one digit of what is not known."""
    if not value or abs(value) <= error:
        return decimal(value, 1)
    known = 1
    while known < _SHOWN and error * 10 ** (known + 1) < abs(value):
        known += 1
    return decimal(value, known)


# -- beside the areas -----------------------------------------------------------------------------


def _mean(hamiltonian: Hamiltonian, task: FlowTask, region: _Carried) -> dict[str, Any]:
    centre = task.shape.centre
    found: Mean = RegionMean(hamiltonian, task.map, task.step_size, task.steps).of(
        region.outline, (float(centre.q), float(centre.p))
    )
    error = Fraction(found.error)
    value = Fraction(found.value)
    agree = abs(value - region.measured.change) <= error + region.measured.error
    return {
        "mean_lambda": _known(value, error),
        "mean_lambda_error": decimal(error, 2),
        "agree": agree,
    }


def _distance(
    hamiltonian: Hamiltonian, span: Fraction, carried: Sequence[_Carried]
) -> dict[str, Any]:
    """The greatest Hausdorff distance of an outline from its image by the exact flow."""
    plane = ExactPlane(hamiltonian, span)
    panels = [z for each in carried for z in each.before]
    q, p = plane.carried(*(np.concatenate([z[i] for z in panels]) for i in (0, 1)))
    images = iter(zip(np.split(q, len(panels)), np.split(p, len(panels)), strict=True))
    greatest, bound = 0.0, 0.0
    for each in carried:
        exact, exact_sagitta = dense([next(images) for _ in each.before])
        own, own_sagitta = dense(each.after)
        found = hausdorff([own], [exact], own_sagitta, exact_sagitta)
        if found.value >= greatest:
            greatest, bound = found.value, found.bound + float(plane.radius or 0)
    return {
        "distance": _known(Fraction(greatest), Fraction(bound)),
        "distance_error": decimal(Fraction(bound), 2),
    }
