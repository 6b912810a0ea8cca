"""atan x, between −π/2 and π/2."""

from verify.functions.function import Function

FUNCTION = Function(
    "atan",
    slope=lambda x, apply: apply("inverse", 1 + x * x),
    lipschitz=1,
    image=lambda t, x: t.angles.arctangent(x),
    turns=True,
    positive=lambda x: x,
    numpy="arctan",
    shown="arctan",
    synonyms=("atg",),
)
