"""Schemes that users write: formulas, and a splitting's coefficients."""
