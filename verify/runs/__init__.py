"""One run of N steps, and the bounds of its numbers."""
