"""Scenes → reference data: orbits and exact flows, every number correctly rounded."""
