"""What is called from Python, one call a file: each takes a system and a scheme, however given."""
