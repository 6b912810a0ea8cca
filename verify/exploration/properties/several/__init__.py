"""Properties that only n degrees of freedom have."""
