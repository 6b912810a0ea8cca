"""A number as it is reported: exact decimal strings, the same after a JSON round trip."""

from typing import Annotated

from pydantic import Field

from verify.scenes.frozen import Frozen

_DECIMAL = r"^-?\d+(\.\d+)?(e[+-]\d+)?$"


class Value(Frozen):
    """A decimal whose printed digits are known, with the bound of its error."""

    value: Annotated[str, Field(pattern=_DECIMAL)]
    bound: Annotated[str, Field(pattern=_DECIMAL)]
