"""Probes of a user's map at a place: its end and its Jacobian, with their noise."""
