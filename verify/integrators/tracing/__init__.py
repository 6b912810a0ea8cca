"""A user's step applied to symbols and to dual numbers."""
