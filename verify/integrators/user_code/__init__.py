"""A user's own code: loaded, understood, called, and watched."""
