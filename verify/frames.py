"""Tables of optional libraries, pandas and xarray."""

from fractions import Fraction
from importlib import import_module
from typing import Any

from verify.errors import InputError


def import_library(name: str, feature: str) -> Any:
    """Import the library of that name; InputError, one line, where it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        raise InputError("library", name, f"is not installed, and {feature} needs it") from None


def nearest_float(text: str) -> float:
    """Return the float nearest to an exact text, a decimal or a quotient; nan for an empty one.

    >>> nearest_float("1/4"), nearest_float("1.5e-03")
    (0.25, 0.0015)
    """
    return float(Fraction(text)) if "/" in text else float(text or "nan")
