"""MSE, the mean of ΔJ² over the steps (Eq. 15)."""

from verify.observables.observable import Ball, Certificate, Observable


def _bound(at: Certificate) -> Ball:
    # A square differs by at most |x − y| (|x| + |y|), each at most `size`.
    total = at.total("mse") * at.steps / at.scale / at.scale
    added = at.adding(total, at.size * at.size)
    return at.scale * at.scale * (2 * at.size * at.moved / at.steps + added)


OBSERVABLE = Observable(
    "mse",
    "MSE",
    r"\text{MSE}",
    order=6,
    usual=4,
    needs="delta_j",
    lines=lambda loop: loop.sum_up("mse", "dj * dj"),
    carried="mse",
    shift=2,
    read=lambda totals, steps: totals[0] / steps,
    constant=lambda delta_j, steps: delta_j**2,
    bound=_bound,
    most_degrees=4,
)
