"""Checks of the strategies' arguments, when a strategy is built and not when it draws."""

from verify.errors import InputError

MOST_DEGREES = 8  # of freedom: people read the formulas that are drawn


def yes_no(name: str, value: object) -> bool:
    """Return True or False as it is; InputError for any other value."""
    if not isinstance(value, bool):
        raise InputError(name, value, "must be True or False")
    return value


def yes_no_either(name: str, value: object) -> bool | None:
    """Return True, False, or None for either, as it is; InputError for any other value."""
    if value is not None and not isinstance(value, bool):
        raise InputError(name, value, "must be True, False, or None for either")
    return value
