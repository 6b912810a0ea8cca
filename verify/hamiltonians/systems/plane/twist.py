"""The twist H = (p² + q²)²/4, not separable: circles that turn with their own velocity p² + q²."""

from fractions import Fraction

from flint import arb

from verify.hamiltonians.named_system import Motion, State, System, Values, at_rest, exactly


def _motion(_: Values, p: Fraction, q: Fraction) -> Motion:
    x, y = exactly(p), exactly(q)

    def state(t: arb) -> State:
        # The action is constant, so the motion is a rotation with the constant rate p² + q².
        s, c = ((x**2 + y**2) * t).sin_cos()
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
    regimes={"rotation": {"p": "6/5", "q": "-8/5"}, "rest": {"p": "0", "q": "0"}},
)
