"""What a user's step does to symbols and to dual numbers."""
