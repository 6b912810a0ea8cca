"""sinh x."""

from verify.functions.function import HYPERBOLA, FixedPoint, Function

FUNCTION = Function(
    "sinh",
    slope=lambda x, apply: apply("cosh", x),
    pair=HYPERBOLA,
    parts=lambda odd, even, over: odd,
    image=lambda t, x: t.half_sum(x, -1),
    positive=lambda x: x,
    fixed=FixedPoint("1.04", share=64),  # half of what e^x and e^−x lose, and of a unit more
    synonyms=("sh",),
)
