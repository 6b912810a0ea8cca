"""Splittings for every H = T(p) + V(q): kicks and drifts in turn."""

from verify.integrators.tables.splittings.claims import AlternatingEntry as Entry
from verify.integrators.tables.splittings.claims import judge_alternating as claims

__all__ = ["Entry", "claims"]
