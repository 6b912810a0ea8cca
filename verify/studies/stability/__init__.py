"""How far a scheme can be pushed, and whose fault it is where it fails."""
