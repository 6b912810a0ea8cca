"""cosh x."""

from verify.functions.function import HYPERBOLA, FixedPoint, Function

FUNCTION = Function(
    "cosh",
    slope=lambda x, apply: apply("sinh", x),
    pair=HYPERBOLA,
    parts=lambda odd, even, over: even,
    image=lambda t, x: t.half_sum(x, 1),
    positive=True,
    fixed=FixedPoint("1.54", share=64),  # half of what e^x and e^−x lose, and of a unit more
    synonyms=("ch",),
)
