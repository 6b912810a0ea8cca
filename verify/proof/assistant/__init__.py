"""Proofs for a proof assistant: the theory, written by hand, and certificates in its words."""
