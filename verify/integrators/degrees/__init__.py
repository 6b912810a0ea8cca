"""A user's own step(p, q, h) of arrays, for an H of several degrees of freedom."""
