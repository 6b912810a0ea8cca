"""The greatest |H − H₀| after any of the steps, by the sum of what H changes in each."""

from verify.observables.observable import Loop, Observable


def _lines(loop: Loop) -> list[str]:
    return [*loop.sum_up("energy", loop.value["de"]), *loop.largest("energy_top", "energy", "sum")]


OBSERVABLE = Observable(
    "energy_error_max",
    "max |H − H₀|",
    r"\max |H - H_0|",
    order=8,
    needs="energy",
    lines=_lines,
    carried="energy_top",
    vanishes=lambda step: step.conserves_energy,
    bound=lambda at: at.bound_of_energy(),
    timed=False,  # H of t is no constant of the motion
)
