"""Properties that speak of orders in h, and of how they are proved."""
