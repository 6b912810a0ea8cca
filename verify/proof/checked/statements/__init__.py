"""One statement a file: what a theorem of the shipped theory says of a kind of scheme."""
