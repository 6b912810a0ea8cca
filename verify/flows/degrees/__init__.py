"""The exact flow in n degrees of freedom: parts that are not coupled, ellipses, numbers."""
