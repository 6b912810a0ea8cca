"""Coefficients as they are printed: whether exact ones near them satisfy a method's conditions."""
