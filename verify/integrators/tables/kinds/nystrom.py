"""Splittings for every H = p·M⁻¹p/2 + V(q): with fewer conditions, for T is quadratic."""

from verify.integrators.tables.splitting_claims import AlternatingEntry, judge_alternating

ENTRY = AlternatingEntry
claims = judge_alternating
