"""The greatest |H − H₀| after any of the steps."""

from verify.observables.integral import greatest_change
from verify.observables.observable import ENERGY

OBSERVABLE = greatest_change(
    "energy_error_max",
    "max |H − H₀|",
    r"\max |H - H_0|",
    ENERGY,
    order=8,
    aside=True,
    vanishes=lambda step: step.conserves_energy,
    timed=False,  # H of t is no constant of the motion
)
