"""S = JᵀΩJ − Ω = c h^order + …, c not the zero form; with `at_least`, S = O(h^order).

In the plane S is ΔJ·Ω, and this is the order of ΔJ.
"""

from typing import Literal

from verify.claims.orders import Order, OrderedClaim
from verify.claims.quantified_claims import OF_S


class DefectOrderClaim(OrderedClaim):
    """The order of S in h; in the plane that of ΔJ."""

    about = OF_S

    kind: Literal["defect_order"]
    defect_order: Order
    """The first power of h in S, or ΔJ."""


CLAIM = DefectOrderClaim
