"""Regions carried by maps: their areas, the mean of Λ over them, how far outlines part."""
