"""Splittings for every H = p·M⁻¹p/2 + V(q): with fewer conditions, for T is quadratic."""

from verify.integrators.tables.splittings.claims import AlternatingEntry as Entry
from verify.integrators.tables.splittings.claims import judge_alternating as claims

__all__ = ["Entry", "claims"]
