"""Λ = Π det J − 1 over the steps (Eq. 16), by the closed form of ΔJ: Λ ← Λ + ΔJ + Λ ΔJ."""

from verify.observables.observable import Observable

OBSERVABLE = Observable(
    "lambda",
    "Λ",
    r"\Lambda",
    order=3,
    usual=5,
    needs="delta_j",
    lines=lambda loop: loop.product(),
    carried="lam",
    shift=1,
    constant=lambda delta_j, steps: (1 + delta_j) ** steps - 1,
    bound=lambda at: at.bound_of_product(),
    growth=4,
    most_degrees=4,
    heading="Λ by closed form",
    plotted="|Λ|",
)
