"""sympy's expressions: what they are made of, and how they are written; no ring is known here."""
