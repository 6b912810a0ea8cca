"""e^x, which is cosh x + sinh x where a ring has these."""

from verify.functions.function import HYPERBOLA, FixedPoint, Function

FUNCTION = Function(
    "exp",
    equation=lambda y: y,
    pair=HYPERBOLA,
    parts=lambda odd, even, over: even + odd,
    image=lambda t, x: t.powers.exponential(x),
    positive=True,
    fixed=FixedPoint("1", share=64),
)
