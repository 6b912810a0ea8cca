"""Truncation and kinds of rounding in Λ, or W, of a float64 run, which add up exactly."""
