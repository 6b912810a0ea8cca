"""sympy's expressions: their parts and their text, independent of any ring."""
