"""Properties that only an H that depends on time has."""
