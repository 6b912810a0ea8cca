"""Properties that speak of whole orbits and of the exact flow."""
