"""The calls from Python; each takes a system and a scheme in any of their forms."""
