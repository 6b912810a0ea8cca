"""Notes on mistakes that matter, which can be sent to those who can correct them."""
