"""Steps as people write them, in units of their own: drawn, spoilt, and judged by mpmath alone."""
