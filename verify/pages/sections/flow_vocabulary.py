"""The words for a region's invariant and for the defect that its change is compared with.

In the plane they are the area and Λ; in n degrees of freedom ∮ p·dq, the integral of ω, and W.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from verify.scenes.results.regions import FlowResult


@dataclass(frozen=True)
class Words:
    """The words for one number of degrees of freedom.

    `invariant`: the measured quantity; `defect`: the quantity whose mean over the region equals its
    change; `not_used`: a quantity that the computation of that mean does not use; `equal_by`: the
    theorem by which the two are equal; `kept_by_flow`: a clause on why the exact flow preserves the
    invariant; `identity`: the identity that is proved for a scheme that preserves it; `heads`: the
    heads of a table's columns; `about`: the explanation of the table.
    """

    invariant: str
    defect: str
    not_used: str
    equal_by: str
    kept_by_flow: str
    identity: str
    heads: tuple[str, ...]
    about: str
    terms: dict[str, Markup]


_PLANE = Words(
    invariant="area",
    defect="Λ",
    not_used="any area",
    equal_by="the change of variables",
    kept_by_flow="the exact flow preserves area by Liouville’s theorem",
    identity="det J ≡ 1",
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
    invariant="∮ p·dq",
    defect="W",
    not_used="any curve",
    equal_by="Stokes’ theorem",
    kept_by_flow="the exact flow keeps ∮ p·dq by Poincaré’s theorem",
    identity="S ≡ 0",
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


def vocabulary_of(flows: Sequence[FlowResult]) -> Words:
    """Return the words for these regions, which are all of one H."""
    return _PLANE if all(flow.plane is None for flow in flows) else _SEVERAL
