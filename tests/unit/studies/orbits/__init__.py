"""Orbits once in each period."""
