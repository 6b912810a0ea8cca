"""Who checked what is proved."""
