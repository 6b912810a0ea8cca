"""The square of side 2 about (0, 0)."""

from fractions import Fraction

from verify.scenes.shapes.outline import Outline, Shape, bezier

_CORNERS = tuple((Fraction(x), Fraction(y)) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
_SIDES = tuple(bezier(_CORNERS[k], _CORNERS[(k + 1) % 4]) for k in range(4))

SHAPE = Shape("square", (Outline("square", _SIDES),))
