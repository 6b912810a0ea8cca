"""Orbits of schemes and of the exact flow where they pass a surface."""
