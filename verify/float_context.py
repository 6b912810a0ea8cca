"""Arrays of float64 behind the names of mpmath's context, so that one formula serves both."""

from typing import Any

import numpy as np

from verify.motion import Number


class FloatContext:
    """What formulas ask of `mp`, elementwise on arrays of float64."""

    pi = np.pi
    prec = 53

    def mpf(self, x: Any) -> Number:
        return np.asarray(x, dtype=np.float64)[()]

    sin = staticmethod(np.sin)
    cos = staticmethod(np.cos)
    exp = staticmethod(np.exp)
    sqrt = staticmethod(np.sqrt)


FLOAT = FloatContext()
