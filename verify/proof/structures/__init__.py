"""Proofs of what one step map keeps: any structure of `verify.structures`."""
