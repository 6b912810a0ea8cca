"""A second look at what is refuted, by means that share no code with the first."""
