"""Turns results into pages and computes nothing itself; `paper/` holds the paper as data."""
