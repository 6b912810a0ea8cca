"""A number as it is reported: exact decimal strings, the same after a JSON round trip."""

from fractions import Fraction
from typing import Annotated

from pydantic import Field

from verify.arithmetic.exact import known_digits
from verify.scenes.frozen import Frozen

_DECIMAL = r"^-?\d+(\.\d+)?(e[+-]\d+)?$"


class Value(Frozen):
    """A decimal whose printed digits are known, with the bound of its error."""

    value: Annotated[str, Field(pattern=_DECIMAL)]
    bound: Annotated[str, Field(pattern=_DECIMAL)]

    @classmethod
    def of(cls, value: Fraction, bound: Fraction, digits: int) -> "Value":
        """The digits of a value that its bound leaves, `digits` at most, and their own bound."""
        shown, within = known_digits(value, bound, digits)
        return cls(value=shown, bound=within)
