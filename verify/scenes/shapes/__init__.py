"""Closed outlines in the plane; `named/` has one shape a file."""
