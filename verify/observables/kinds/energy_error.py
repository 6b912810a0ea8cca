"""H − H₀ after the last step, with its sign."""

from verify.observables.integral import change_at_end
from verify.observables.observable import ENERGY

OBSERVABLE = change_at_end(
    "energy_error",
    "H − H₀",
    "H - H_0",
    ENERGY,
    order=9,
    aside=True,
    vanishes=lambda step: step.conserves_energy,
    timed=False,  # H of t is no constant of the motion
)
