"""Reference data against itself, its schemas, and other code that computes it again."""
