"""What the area of a region is called, and what its change is held against, by degrees of freedom.

In the plane it is an area and Λ; in n degrees of freedom ∮ p·dq, ω's area, and the defect W.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from verify.scenes.results.regions import FlowResult


@dataclass(frozen=True)
class Words:
    """`measured`: what changes; `mean`: of what over the region; `without`: what that does not look
    at; `equal_by`: why the two are the same; `kept` and `proved`: why it is kept by the exact flow,
    and what is proved of schemes; `heads`: of a table's columns; `about` such a table."""

    measured: str
    mean: str
    without: str
    equal_by: str
    kept: str
    proved: str
    heads: tuple[str, ...]
    about: str
    terms: dict[str, Markup]


_PLANE = Words(
    measured="area",
    mean="Λ",
    without="any area",
    equal_by="the change of variables",
    kept="the exact flow preserves area by Liouville’s theorem",
    proved="det J ≡ 1",
    heads=("N", "t", "change of area", "mean of Λ", "distance", "arithmetic"),
    about=(
        "Changes of area and the mean of Λ are relative to the area before. A distance is that of "
        "Hausdorff between the outlines by the scheme and by the exact flow, the greatest of all "
        "outlines, in the units of q and p. Below each number stands its error; a mean of 0 is by "
        "proof."
    ),
    terms={
        "Change of area": Markup(
            "The area inside the image of a closed outline, less that inside the outline, divided "
            "by the latter: ∮ p dq along both, refined until the quadrature’s own error is far "
            "below the change. It equals the mean of Λ over the region, which is computed beside "
            "it without any area."
        ),
        "Distance of outlines": Markup(
            "Hausdorff’s: the farthest that a point of either outline is from the other one."
        ),
    },
)
_SEVERAL = Words(
    measured="∮ p·dq",
    mean="W",
    without="any curve",
    equal_by="Stokes’ theorem",
    kept="the exact flow keeps ∮ p·dq by Poincaré’s theorem",
    proved="S ≡ 0",
    heads=("N", "t", "change of ∮ p·dq", "mean of W", "by planes", "arithmetic"),
    about=(
        "The change of ∮ p·dq along the outline and the mean of W over the region are relative to "
        "∮ p·dq before. By planes: what the projection of the outline to (q₁, p₁), (q₂, p₂), … "
        "encloses, relative to the same; their sum is 1 and the change. Below each number stands "
        "its error; a mean of 0 is by proof."
    ),
    terms={
        "∮ p·dq": Markup(
            "Poincaré’s invariant: p₁ dq₁ + … + pₙ dqₙ along a closed curve, the sum of the areas "
            "that its projections to the planes (q₁, p₁), …, (qₙ, pₙ) enclose, with their signs. "
            "The exact flow and symplectic maps keep the sum, and not each of them. Along the "
            "outline of a region it is the integral of ω over it."
        ),
        "W": Markup(
            "MᵀΩM − Ω for M the Jacobian of all N steps. Its entry at (p, q) of the plane in which "
            "the region lies, averaged over the region, is the relative change of ∮ p·dq along the "
            "outline, by Stokes’ theorem; it is computed without any curve."
        ),
    },
)


def words(flows: Sequence[FlowResult]) -> Words:
    """Those for regions of one H."""
    return _PLANE if all(flow.plane is None for flow in flows) else _SEVERAL
