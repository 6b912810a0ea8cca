"""I − I₀ after the last step, for the formula of a function I of the coordinates."""

from verify.observables.integral import change_at_end
from verify.observables.observable import Observable


def member(formula: str) -> Observable:
    """Return the observable of a formula."""
    label = f"I − I₀, I = {formula}"
    return change_at_end(f"integral_error: {formula}", label, "I - I_0", formula, order=11)
