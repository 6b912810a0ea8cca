"""What float64 multiplies along a run: determinants in the plane, matrices beyond it."""
