"""A float64 run, step by step, with exact arithmetic beside it."""
