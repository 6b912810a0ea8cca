"""Systems of two degrees of freedom."""
