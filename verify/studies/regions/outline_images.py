"""Images of outlines under a map: their results, and their distance from the exact images.

The distance is Hausdorff's (`verify.studies.regions.hausdorff`).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from verify.arithmetic.exact import known_text, upper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.regions import CarriedOutline, Projection
from verify.scenes.shapes.outline import Outline
from verify.studies.regions.hausdorff import FARTHEST, hausdorff
from verify.studies.regions.panels import densify
from verify.studies.regions.point_carriers import ExactFlowCarrier, RegionPlane
from verify.studies.regions.polyline import format_points
from verify.studies.regions.region_area import MeasuredArea

_POINTS_BEFORE_THINNING = 20_000  # points of a drawn curve
_MAX_DIGITS = 12  # significant digits of a printed area
_SAFETY = 1.01  # between the points of dense curves the distance may be greater than at them
_Nodes = Sequence[tuple[np.ndarray, ...]]  # q and p of each panel's nodes


@dataclass(frozen=True)
class OutlineImage:
    """One outline under the map: its panels' nodes before and after, in float64."""

    outline: Outline
    measured: MeasuredArea
    before: list[tuple[np.ndarray, ...]]
    after: list[tuple[np.ndarray, ...]]
    plane: RegionPlane

    def curve(self, index: int) -> np.ndarray:
        """Return the image in the plane (q_k, p_k), k − 1 = index: points (n, 2)."""
        n = self.plane.degrees
        return densify([(z[index], z[n + index]) for z in self.after], _POINTS_BEFORE_THINNING)[0]


# -- results --------------------------------------------------------------------------------------


def build_outline(image: OutlineImage, curves: Sequence[np.ndarray]) -> CarriedOutline:
    """Build the result of one outline; `curves`: one for each plane (q_k, p_k)."""
    region, plane = image.measured, image.plane
    area = abs(region.area)  # the area inside a clockwise curve is negative
    change, error = format_with_error(region.change, region.error)
    return CarriedOutline(
        name=image.outline.name,
        area=format_with_error(area, area * region.error)[0],
        area_change=change,
        probe_error=error,
        nodes=region.nodes,
        points=format_points(curves[plane.index]),
        projections=tuple(_build_projections(region, curves)) if plane.degrees > 1 else (),
    )


def _build_projections(region: MeasuredArea, curves: Sequence[np.ndarray]) -> Iterator[Projection]:
    for k, ((value, error), curve) in enumerate(zip(region.parts, curves, strict=True)):
        area, bound = format_with_error(value, error)
        yield Projection(plane=k + 1, area=area, area_error=bound, points=format_points(curve))


def format_with_error(value: Fraction, error: Fraction) -> tuple[str, str]:
    """Format the value with one digit more than is known, and its error with that of the text."""
    value_text = known_text(value, error / 10, _MAX_DIGITS)
    return value_text, upper(error + abs(value - Fraction(value_text)))


# -- distances ------------------------------------------------------------------------------------


def distance_from_exact(
    hamiltonian: Hamiltonian,
    time: Fraction,
    t0: Fraction,
    images: Sequence[OutlineImage],
) -> tuple[Fraction, Fraction] | None:
    """Return the greatest Hausdorff distance of an outline from its exact image, with its error.

    The exact flow goes from t0 for the length `time`, in the plane. None if an image is too far
    away for its distance to be measured in float64. Raises NoFlowError.
    """
    # Squares of such coordinates would overflow in float64.
    if any(np.abs(z).max() > FARTHEST for image in images for z in image.after):
        return None
    carrier = ExactFlowCarrier(hamiltonian, time, t0)
    panels = [z for image in images for z in image.before]
    q, p = carrier.images(*(np.concatenate([z[i] for z in panels]) for i in (0, 1)))
    exact_nodes = iter(zip(np.split(q, len(panels)), np.split(p, len(panels)), strict=True))
    distances = [
        _curve_distance(image.after, [next(exact_nodes) for _ in image.before]) for image in images
    ]
    greatest, bound = _greatest_with_error(distances)
    return Fraction(greatest), Fraction(bound) + (carrier.radius or 0)


def _greatest_with_error(values: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return the greatest of values with errors, and the error of the maximum."""
    greatest = max(value for value, _ in values)
    most, least = (max(value + sign * error for value, error in values) for sign in (1, -1))
    return greatest, max(most - greatest, greatest - least)


def _curve_distance(nodes: _Nodes, exact_nodes: _Nodes) -> tuple[float, float]:
    """Return the Hausdorff distance of two curves with its error, from the nodes of their panels.

    It is cut to the greatest distance of two images of the same point, which it cannot exceed.
    """
    (curve, sagitta), (exact_curve, exact_sagitta) = densify(nodes), densify(exact_nodes)
    distance = hausdorff([curve], [exact_curve], sagitta, exact_sagitta)
    # Points of the same index come from the same point of the outline, as both curves have the same
    # panels and nodes.
    most = float(np.hypot(*(curve - exact_curve).T).max()) * _SAFETY
    return min(distance.value, most), min(
        distance.bound, max(most - distance.value, distance.value)
    )
