"""The unit circle."""

from verify.arithmetic.float_context import Context, Number
from verify.scenes.shapes.outline import Outline, Shape, angle


def _circle(mp: Context, s: Number) -> tuple[Number, Number]:
    turn = angle(mp, s)
    return mp.cos(turn), mp.sin(turn)


SHAPE = Shape("circle", (Outline("circle", (_circle,)),))
