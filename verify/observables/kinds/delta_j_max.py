"""max |ΔJ| over the steps, ΔJ = det J − 1 (Eq. 14)."""

from verify.observables.observable import Observable

OBSERVABLE = Observable(
    "delta_j_max",
    "max |ΔJ|",
    r"\max |\Delta J|",
    order=7,
    usual=3,
    needs="delta_j",
    lines=lambda loop: loop.largest("top", "dj"),
    carried="top",
    shift=1,
    constant=lambda delta_j, steps: abs(delta_j),
    bound=lambda at: at.scale * (at.slope * at.error + at.rounded.delta_j),
    most_degrees=4,  # beyond, a Pfaffian is too long
)
