"""What is proved of a scheme, for one H or for every H."""
