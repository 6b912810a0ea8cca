"""Terms that couple two degrees of freedom, i and j: of q alone, of p alone, or of both.

Those of q alone or of p alone leave H = T + V; of the others a mixed derivative such as
∂²H/∂p1∂q2 is not the zero function. What is known of each: whether it is bounded below where its
coefficient is positive or it is bounded (`confined`), so that H → ∞ in every direction stays so;
and whether it is bounded on every axis (`flat`), so that an H that is open along one stays so.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from verify.strategies.terms import Drawer, power, times


class Coupling(NamedTuple):
    """Numerator and denominator with p, q for the first degree and P, Q for the second."""

    numerator: str
    denominator: str = ""
    positive: bool = False  # whether the coefficient has to be


class Form(NamedTuple):
    """How a coupling is drawn, of which degree its polynomial is, and what is known of it."""

    draw: Callable[[Drawer], Coupling]
    kind: str
    separable: bool
    degree: int = 0
    confined: bool = False
    flat: bool = True


def _bilinear(d: Drawer) -> Coupling:
    return Coupling(d.pick(("q*Q", "p*P")))


def _springs(d: Drawer) -> Coupling:
    """A spring between two masses."""
    return Coupling("(q - Q)**2", positive=True)


def _henon_heiles(d: Drawer) -> Coupling:
    return Coupling(d.pick(("q**2*Q", "q*Q**2")))


def _squares(d: Drawer) -> Coupling:
    return Coupling(d.pick(("q**2*Q**2", "p**2*P**2")), positive=True)


def _rotation(d: Drawer) -> Coupling:
    return Coupling(d.pick(("p*Q", "P*q")))


def _magnetic(d: Drawer) -> Coupling:
    return Coupling(f"(p - {times(d.inner(), 'Q')})**2", positive=True)


def _mixed_power(d: Drawer) -> Coupling:
    return Coupling(f"{power('q', d.whole(1, 2))}*P")


def _mixed_squares(d: Drawer) -> Coupling:
    return Coupling(d.pick(("p**2*Q**2", "P**2*q**2")), positive=True)


def _waves(d: Drawer) -> Coupling:
    """What couples two pendulums."""
    return Coupling(f"{d.pick(('cos', 'sin'))}(q - {d.pick(('', '2*'))}Q)")


def _mixed_waves(d: Drawer) -> Coupling:
    return Coupling(f"{d.pick(('cos', 'sin'))}(p + {times(d.inner(), 'Q')})")


def _bumps(d: Drawer) -> Coupling:
    return Coupling(d.pick(("exp(-q**2 - Q**2)", "exp(-p**2 - P**2)")))


def _toda(d: Drawer) -> Coupling:
    return Coupling("exp(q - Q)", positive=True)


def _mixed_bumps(d: Drawer) -> Coupling:
    return Coupling(d.pick(("exp(-p**2 - Q**2)", "exp(-q**2 - P**2)")))


def _wells(d: Drawer) -> Coupling:
    """A soft well between two bodies."""
    return Coupling("", f"{d.whole(1, min(d.limits.size, 9))} + (q - Q)**2")


def _mixed_wells(d: Drawer) -> Coupling:
    return Coupling("q*P", f"{d.whole(1, min(d.limits.size, 9))} + q**2 + P**2")


_FORMS = (
    Form(_bilinear, "polynomial", True, 2),
    Form(_springs, "polynomial", True, 2, confined=True, flat=False),
    Form(_henon_heiles, "polynomial", True, 3),
    Form(_squares, "polynomial", True, 4, confined=True),
    Form(_rotation, "polynomial", False, 2),
    Form(_magnetic, "polynomial", False, 2, confined=True, flat=False),
    Form(_mixed_power, "polynomial", False, 3),
    Form(_mixed_squares, "polynomial", False, 4, confined=True),
    Form(_waves, "trigonometric", True, confined=True),
    Form(_mixed_waves, "trigonometric", False, confined=True),
    Form(_bumps, "exponential", True, confined=True),
    Form(_toda, "exponential", True, confined=True, flat=False),
    Form(_mixed_bumps, "exponential", False, confined=True),
    Form(_wells, "rational", True, confined=True),
    Form(_mixed_wells, "rational", False, confined=True),
)


def forms(kind: str, degree: int, *, separable: bool, bounded: bool | None) -> Iterator[Form]:
    """Those that an H of the kind may have, of a polynomial up to the degree, the simplest first.

    Of an H that is not of one variable each, those of both variables come first.
    """
    for form in sorted(_FORMS, key=lambda form: form.separable != separable):
        fits = form.kind in ("polynomial", kind) and form.degree <= degree
        known = {None: True, True: form.confined, False: form.flat}[bounded]
        if fits and known and (form.separable or not separable):
            yield form
