"""Measurements of a user's map: its structure, and its distance from the exact flow."""
