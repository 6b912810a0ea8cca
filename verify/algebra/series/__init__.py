"""Series in h, and the derivatives of every H as variables."""
