"""Splittings for every H = T(p) + V(q): kicks and drifts in turn."""

from verify.integrators.tables.splitting_claims import AlternatingEntry, judge_alternating

ENTRY = AlternatingEntry
claims = judge_alternating
