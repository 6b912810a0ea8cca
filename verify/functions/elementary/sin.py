"""sin x."""

from verify.functions.function import CIRCLE, FixedPoint, Function

FUNCTION = Function(
    "sin",
    slope=lambda x, apply: apply("cos", x),
    lipschitz=1,
    pair=CIRCLE,
    parts=lambda odd, even, over: odd,
    image=lambda t, x: t.angles.cos_and_sin(x)[1],
    bounded=True,
    fixed=FixedPoint("0.6"),
)
