"""Measurements of a user's map: readings at a place, its structure, its distance from the flow."""
