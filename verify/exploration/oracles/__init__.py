"""Steps in ball arithmetic, in other coordinates, and in many digits: what properties hold kernels
and maps against."""
