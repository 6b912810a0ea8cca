"""The observables, one a file."""
