"""Autonomous systems of one degree of freedom."""
