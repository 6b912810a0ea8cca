"""Kernels: step map → program → loop → N steps, and bounds on the rounding of one step."""
