"""cos x."""

from verify.functions.function import CIRCLE, FixedPoint, Function

FUNCTION = Function(
    "cos",
    slope=lambda x, apply: -apply("sin", x),
    lipschitz=1,
    pair=CIRCLE,
    parts=lambda odd, even, over: even,
    image=lambda t, x: t.angles.cos_and_sin(x)[0],
    bounded=True,
    fixed=FixedPoint("0.6"),
)
