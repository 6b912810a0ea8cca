"""Somebody's numbers beside the reference data: what agrees, what parts, and why."""
