"""The greatest |entry| of W, which has all steps' defects: W ← W + MᵀSM, then M ← J M."""

from fractions import Fraction

from verify.observables.observable import Loop, Observable


def _lines(loop: Loop) -> list[str]:
    """Return the statements entry by entry; all increments are computed before."""
    lines = loop.matrix()
    for name, increment in loop.value.items():
        if name.startswith("dw_"):
            lines += loop.sum_up(name[1:], increment)
    return lines


OBSERVABLE = Observable(
    "symplectic_defect",
    "max |W|",
    r"\max |W|",
    order=2,
    usual=2,
    needs="carried",
    lines=_lines,
    carried="w_",
    shift=1,
    read=lambda totals, steps: max(map(abs, totals), default=Fraction(0)),
    bound=lambda at: at.bound_of_form(),
    growth=9,
    most_degrees=4,  # products of matrices
    in_plane="lambda",
)
