"""Truncated Taylor series of the flow."""
