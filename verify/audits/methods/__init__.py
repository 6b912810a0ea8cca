"""What is judged: how a method of others is driven or read, and what is found of it at once."""
