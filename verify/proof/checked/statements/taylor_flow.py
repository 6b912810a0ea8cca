"""The step of lieη agrees with the flow up to h^η."""

from verify.proof.checked.theory_marks import Applies, eta_of, for_every

APPLIES = Applies(
    about="map",
    applies=lambda proved: eta_of(proved) is not None,
    theorems=("Theorems.flow_has_taylor_series",),
    says=lambda proved: (
        f"{for_every(proved)} every solution of Hamilton’s equations lies within "
        f"C `h^{(eta_of(proved) or 0) + 1}` of its Taylor polynomial, which the step is"
    ),
)
