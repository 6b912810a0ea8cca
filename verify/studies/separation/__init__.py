"""Truncation and four kinds of rounding in Λ of a float64 run, which add up exactly."""
