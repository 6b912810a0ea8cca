"""Products along a float64 run: of determinants in the plane, of matrices in more degrees."""
