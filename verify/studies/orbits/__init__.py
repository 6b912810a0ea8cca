"""Orbits looked at now and then: once in each period of H, or where they pass a surface."""
