"""The greatest |I − I₀| after any of the steps, for the formula of a function I."""

from verify.observables.integral import greatest_change
from verify.observables.observable import Observable


def member(formula: str) -> Observable:
    """Return the observable of a formula."""
    label = f"max |I − I₀|, I = {formula}"
    return greatest_change(
        f"integral_error_max: {formula}", label, r"\max |I - I_0|", formula, order=10
    )
