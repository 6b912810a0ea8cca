"""Runge–Kutta tables of all kinds: their conditions by trees, and what they claim."""
