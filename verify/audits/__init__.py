"""Released integrators and printed tables, held against what they claim."""
