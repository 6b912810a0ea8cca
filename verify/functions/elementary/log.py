"""log x, the natural logarithm, of positive x."""

from verify.functions.function import Domain, FixedPoint, Function

FUNCTION = Function(
    "log",
    slope=lambda x, apply: apply("inverse", x),
    domain=Domain(">"),
    image=lambda t, x: t.logarithm(x),
    positive=lambda x: x - 1,
    fixed=FixedPoint("0.6"),
    shown="ln",
    synonyms=("ln",),
)
