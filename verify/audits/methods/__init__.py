"""Methods by which an integrator is driven or read, and what is measured of it at once."""
