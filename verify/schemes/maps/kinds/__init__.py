"""Kinds of coefficients, one a file, each with the map that it makes."""
