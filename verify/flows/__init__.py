"""The exact flow: in closed form, by extrapolation, along closed orbits."""
