"""Schemes as they are for every H, by coefficients, and conditions on these."""
