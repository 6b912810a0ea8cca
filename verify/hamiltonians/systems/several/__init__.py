"""Systems of several degrees of freedom."""
