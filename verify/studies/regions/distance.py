"""How far outlines are from where the exact flow carries them: Hausdorff's distance."""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.regions.hausdorff import FARTHEST, hausdorff
from verify.studies.regions.point_carriers import ExactFlowCarrier
from verify.studies.regions.polyline import dense

_SAFETY = 1.01  # for what lies between the points of dense curves
_Nodes = Sequence[tuple[np.ndarray, ...]]  # of panels, q and p of each


def distance_from_exact(
    hamiltonian: Hamiltonian,
    time: Fraction,
    t0: Fraction,
    outlines: Sequence[tuple[_Nodes, _Nodes]],
) -> tuple[Fraction, Fraction] | None:
    """The greatest Hausdorff distance of an outline from its image by the exact flow, with its
    error; None where an image is too far away for it.

    `outlines`: of each its panels' nodes before and after. Raises NoFlowError.
    """
    if any(np.abs(z).max() > FARTHEST for _, after in outlines for z in after):
        return None
    plane = ExactFlowCarrier(hamiltonian, time, t0)
    panels = [z for before, _ in outlines for z in before]
    q, p = plane.images(*(np.concatenate([z[i] for z in panels]) for i in (0, 1)))
    images = iter(zip(np.split(q, len(panels)), np.split(p, len(panels)), strict=True))
    apart = [_apart(after, [next(images) for _ in before]) for before, after in outlines]
    greatest, bound = _greatest(apart)
    return Fraction(greatest), Fraction(bound) + (plane.radius or 0)


def _greatest(values: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """The greatest of values with errors, with its error: a smaller one may be less well known."""
    greatest = max(value for value, _ in values)
    most, least = (max(value + sign * error for value, error in values) for sign in (1, -1))
    return greatest, max(most - greatest, greatest - least)


def _apart(own: _Nodes, exact: _Nodes) -> tuple[float, float]:
    """The Hausdorff distance of two curves with its error, from the nodes of their panels.

    It is at most the greatest distance of points that come from one and the same point.
    """
    (one, sagitta), (other, other_sagitta) = dense(own), dense(exact)
    found = hausdorff([one], [other], sagitta, other_sagitta)
    most = float(np.hypot(*(one - other).T).max()) * _SAFETY
    return min(found.value, most), min(found.bound, max(most - found.value, found.value))
