"""The greatest |entry| of any S = JᵀΩJ − Ω of the steps."""

from verify.observables.observable import Loop, Observable


def _lines(loop: Loop) -> list[str]:
    loop.carry("s_top", 0)
    return [line for entry in loop.entries for line in loop.largest("s_top", entry)]


OBSERVABLE = Observable(
    "symplectic_defect_max",
    "max |S|",
    r"\max |S|",
    order=1,
    usual=1,
    needs="symplectic",
    lines=_lines,
    carried="s_top",
    shift=1,
    bound=lambda at: at.slope_of_form() * at.error + at.scale * at.rounded.defect,
    most_degrees=8,  # S has n(2n − 1) entries
    in_plane="delta_j_max",
)
