"""Where tasks are computed, and what is kept of them."""
