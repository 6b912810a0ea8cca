"""Sections of orbits: states once in each period of H, or where orbits pass a surface."""
