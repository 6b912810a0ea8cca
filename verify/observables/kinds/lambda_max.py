"""The greatest |Λ| after any of the steps.

The bound on the error of the last Λ holds for each before it too: all its sums go up to N.
"""

from verify.observables.observable import Observable

OBSERVABLE = Observable(
    "lambda_max",
    "max |Λ|",
    r"\max |\Lambda|",
    order=5,
    needs="delta_j",
    lines=lambda loop: [*loop.product(), *loop.largest("lam_top", "lam", "sum")],
    carried="lam_top",
    shift=1,
    # (1 + ΔJ)^k moves in one direction.
    constant=lambda delta_j, steps: abs((1 + delta_j) ** steps - 1) if delta_j > -1 else None,
    bound=lambda at: at.bound_of_product(),
    growth=4,
    most_degrees=4,
)
