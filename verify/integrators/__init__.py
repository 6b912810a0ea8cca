"""Somebody else's step function: loaded, traced, proved or measured, and judged."""
