"""Properties held against sampled scenes, and the scenes that are worst for float64."""
