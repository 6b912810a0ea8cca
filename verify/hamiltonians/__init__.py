"""H(p, q) with exact parameters, its Lie derivatives, and motion known in closed form."""
