"""Proofs about a scheme, for one H or for every H."""
