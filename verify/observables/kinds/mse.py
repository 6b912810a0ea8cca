"""MSE, the mean of ΔJ² over the steps (Eq. 15)."""

from verify.observables.observable import Ball, Certificate, Observable


def _bound(certificate: Certificate) -> Ball:
    # A square differs by at most |x − y| (|x| + |y|), each at most `size`.
    total = certificate.total("mse") * certificate.steps / certificate.scale / certificate.scale
    rounding = certificate.adding(total, certificate.size * certificate.size)
    return (
        certificate.scale
        * certificate.scale
        * (2 * certificate.size * certificate.sum_of_shifts / certificate.steps + rounding)
    )


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
