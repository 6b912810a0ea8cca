"""The words for a region's invariant and for the defect that its change is compared with.

In the plane they are the area and Λ; in n degrees of freedom ∮ p·dq, the integral of ω, and W.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from verify.pages.text.legend import terms_of
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
    terms=terms_of("region-in-plane"),
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
    terms=terms_of("region-in-degrees"),
)


def vocabulary_of(flows: Sequence[FlowResult]) -> Words:
    """Return the words for these regions, which are all of one H."""
    return _PLANE if all(flow.plane is None for flow in flows) else _SEVERAL
