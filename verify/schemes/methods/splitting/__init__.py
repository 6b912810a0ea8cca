"""Compositions of kicks and drifts, for H = T(p) + V(q)."""
