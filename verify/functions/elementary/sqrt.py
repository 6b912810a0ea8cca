"""√x, which a ring, a program and a page have as a root, that is a power."""

from verify.functions.function import Domain, FixedPoint, Function

FUNCTION = Function(
    "sqrt",
    slope=lambda x, apply: apply("inverse", 2 * apply("sqrt", x)),
    domain=Domain(">="),
    # s + (x − s s)/(2 s) with s ≥ 2^−13.
    fixed=FixedPoint("2056"),
)
