"""Orbits of a scheme at multiples of a period of H."""
