"""The references for kernels and maps: steps in balls, in other coordinates, and in many digits."""
