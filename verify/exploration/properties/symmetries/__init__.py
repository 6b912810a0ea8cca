"""Properties that speak of what a step keeps: area, coordinates, time."""
