"""The proof assistant: its theory, and what is exported for it."""
