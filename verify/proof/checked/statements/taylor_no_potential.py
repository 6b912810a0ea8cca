"""The leading coefficient of lieη does not telescope for odd η: the oscillator shows it."""

from verify.proof.checked.theory_marks import Applies, eta_of

APPLIES = Applies(
    about="telescopes",
    applies=lambda proved: (
        proved.for_every_h and not proved.timed and (eta_of(proved) or 0) % 2 == 1
    ),
    theorems=(),
    in_plane=("Theorems.lie_does_not_telescope_for_odd",),
    says=lambda _: "for H = (p² + q²)/2 the leading coefficient is X·G for no smooth G",
)
