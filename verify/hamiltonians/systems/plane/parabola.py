"""A bead on the parabola y = q²/2 under gravity: not separable, and no closed form.

Its time is an elliptic integral of the second kind of q, which has no inverse by named functions.
"""

from verify.hamiltonians.named_system import System

SYSTEM = System(
    name="parabola",
    title="bead on a parabola",
    formula="p**2/(2*(1 + q**2)) + q**2/2",
    source="kinetic energy (1 + q²) q'²/2 and potential y = q²/2",
    goes=lambda _, __, ___: None,  # |q| is bounded by H, and then p is
    regimes={"oscillation": {"p": "1/2", "q": "-3/2"}, "rest": {"p": "0", "q": "0"}},
)
