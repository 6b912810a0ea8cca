"""Schemes for every H, by coefficients, and conditions on these."""
