"""Stability: the limits of a scheme, and the cause where a run fails."""
