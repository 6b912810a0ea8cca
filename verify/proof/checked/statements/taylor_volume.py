"""The order of det J − 1 of lieη in n degrees of freedom."""

from verify.proof.checked.theory_marks import Applies, divergence, first_term, is_lie

APPLIES = Applies(
    about="volume",
    applies=is_lie,
    theorems=("Theorems.determinant_of_lie",),
    says=lambda proved: first_term(proved, "det J − 1", divergence(proved)),
)
