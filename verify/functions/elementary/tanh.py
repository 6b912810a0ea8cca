"""tanh x = sinh x / cosh x, which a ring writes so."""

from verify.functions.function import HYPERBOLA, Function

FUNCTION = Function(
    "tanh",
    equation=lambda y: 1 - y * y,
    pair=HYPERBOLA,
    parts=lambda odd, even, over: over(odd, even),
    synonyms=("th",),
)
