"""Kinds of claims that compare runs with each other, with the exact solution, or with a table."""
