"""Theorems on the paper's four criteria of area preservation, and maps that tell them apart."""
