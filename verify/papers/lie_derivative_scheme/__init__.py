"""Sentences of the paper on area preservation of the Lie-derivative scheme, one subject a file."""
