"""Languages, one a file; see `verify.schemes.export`."""
