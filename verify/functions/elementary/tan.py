"""tan x = sin x / cos x, which a ring writes so."""

from verify.functions.function import CIRCLE, Domain, Function

FUNCTION = Function(
    "tan",
    equation=lambda y: 1 + y * y,
    domain=Domain("!=", through="cos"),
    pair=CIRCLE,
    parts=lambda odd, even, over: over(odd, even),
    synonyms=("tg",),
)
