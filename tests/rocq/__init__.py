"""What Rocq's `coqc` says of the theory and of exported certificates."""

# Exports that are taken without the theory beside them, too: one for one H, one by coefficients.
# They hold what they need of it, which takes as long as to compile that.
STAND_ALONE = ("duffing_lie2", "yoshida4")
