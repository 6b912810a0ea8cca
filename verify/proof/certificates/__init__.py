"""Certificates: the identities behind a proof, as JSON, and a checker independent of the prover."""
