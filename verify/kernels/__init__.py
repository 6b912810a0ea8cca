"""Kernels: step map → program → loop → N steps, and bounds on the rounding error of one step."""
