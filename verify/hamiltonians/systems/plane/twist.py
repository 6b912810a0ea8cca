"""The twist H = (p² + q²)²/4, not separable: circles that turn with their own velocity p² + q²."""

from fractions import Fraction

from verify.hamiltonians.motion import Context, Motion, Number, State, Values, at_rest, number
from verify.hamiltonians.named_system import System


def _motion(_: Values, p: Fraction, q: Fraction) -> Motion:
    def state(mp: Context, t: Number) -> State:
        x, y, angle = number(mp, p), number(mp, q), number(mp, p**2 + q**2) * t
        c, s = mp.cos(angle), mp.sin(angle)
        return x * c - y * s, y * c + x * s

    if p == q == 0:
        return at_rest(p, q)
    return Motion(state, "closed form: elementary functions")


SYSTEM = System(
    name="twist",
    title="twist",
    formula="(p**2 + q**2)**2/4",
    source="H = I² of the action I = (p² + q²)/2: the least nonlinear integrable H",
    flow=_motion,
    regimes={
        "rotation": {"p": "6/5", "q": "-8/5"},
        "rest": {"p": "0", "q": "0"},
    },
)
