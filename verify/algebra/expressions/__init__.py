"""sympy's expressions: their parts and their text, without any ring."""
