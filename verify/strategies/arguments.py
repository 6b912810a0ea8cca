"""What the strategies take as arguments: whole numbers and exact ones, looked at when they are
given, not when something is drawn."""

from verify.arithmetic.exact import whole as whole
from verify.errors import InputError

MOST_DEGREES = 8  # of freedom, of what is drawn: its formulas are to be read


def yes_no(name: str, value: object) -> bool:
    """True or False; else InputError."""
    if not isinstance(value, bool):
        raise InputError(name, value, "must be True or False")
    return value


def yes_no_either(name: str, value: object) -> bool | None:
    """True, False, or None for either; else InputError."""
    if value is not None and not isinstance(value, bool):
        raise InputError(name, value, "must be True, False, or None for either")
    return value
