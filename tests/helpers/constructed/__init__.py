"""Results and data by hand, that say what a test wants."""
