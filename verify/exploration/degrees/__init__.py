"""Steps in n degrees of freedom in ball arithmetic, and in other coordinates: oracles."""
