"""Properties that only the plane has."""
