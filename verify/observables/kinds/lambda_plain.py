"""Λ the plain way, as users compute it: the four entries of J, their determinant, the product.

It serves to measure rounding, so no proof gives it, and it has no certificate: it is compared with
Λ by the closed form.
"""

from verify.observables.observable import Loop, Observable, never


def _lines(loop: Loop) -> list[str]:
    loop.carry("plain", 1)
    return [f"plain = plain * {loop.value['det']}"]


OBSERVABLE = Observable(
    "lambda_plain",
    "Λ, the plain way",
    r"\Lambda_{\text{plain}}",
    order=4,
    needs="determinant",
    lines=_lines,
    carried="plain",
    begins=1,
    vanishes=never,
    most_degrees=1,
    heading="Λ the plain way",
    plotted="|Λ|, the plain way",
    short="Λ, plain",
)
