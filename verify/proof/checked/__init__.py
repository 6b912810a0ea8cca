"""Marks of who checked a proof about a scheme."""
