"""Turns results into pages; computes nothing itself. `paper/` holds the paper's scenes and claims."""
