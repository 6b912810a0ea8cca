"""Properties that speak of numbers: systems, bounds, parts, text."""
