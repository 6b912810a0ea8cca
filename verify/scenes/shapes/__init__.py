"""Closed outlines in the plane; `named/` has a file for each shape."""
