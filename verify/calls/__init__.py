"""The calls from Python, one a file; each takes a system and a scheme in any of their forms."""
