"""Proofs: exact algebra, whose answers are PROVED, REFUTED or UNDECIDED."""
