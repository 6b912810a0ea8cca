"""The argument for `lieη` of every η and every H at once, step by step.

The machine's own proof is for one η at a time. Each step names the theorems of the shipped theory
for Rocq that state it, by file and name; one step has none.
"""

from verify.prose import Prose, join_prose, read_prose

STEPS: tuple[tuple[str, tuple[str, ...]], ...] = (
    (
        "The exact flow has det 1: the coefficients of h, h², … in the determinant of its "
        "series vanish.",
        ("Taylor.flow_has_no_defect",),
    ),
    (
        "The scheme shares its terms up to `h^η`, so the coefficients of h … `h^η` vanish for "
        "it too.",
        ("Volume.volume_below",),
    ),
    (
        "In that of `h^(η+1)` the flow has one term more, which is linear. With f = (−`H_q`, "
        "`H_p`) the scheme’s coefficient is ``L = −div(X^η f)/(η+1)!``.",
        ("Theorems.determinant_of_lie_in_plane",),
    ),
    (
        "For even η it is X·G with `P_(a, b)` = ∂(Xᵃp, `X^b` q)/∂(p, q) and ``G = −1/(η+1)! "
        "Σ_{k=0}^{η} (−1)^k P_{η−k, k}``: in X·G all terms but the ends cancel.",
        ("Theorems.lie_telescopes_in_plane_for_even",),
    ),
    (
        "Along an orbit the leading term therefore sums to a boundary term, and Λ gains one "
        "order in h.",
        (),
    ),
    (
        "For odd η it does not telescope. X·G vanishes at an equilibrium for every smooth G, "
        "and for H = (p² + q²)/2 L is ``2 (−1)^j/(2j+2)!`` there, η = 2j + 1.",
        ("Oscillator.oscillator_first_for_odd", "Theorems.lie_does_not_telescope_for_odd"),
    ),
)


def paragraph() -> Prose:
    """Join the steps into one paragraph."""
    return join_prose(" ", [*(read_prose(text) for text, _ in STEPS), "∎"])
