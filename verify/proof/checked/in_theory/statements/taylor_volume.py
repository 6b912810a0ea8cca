"""The order of det J − 1 of lieη in n degrees of freedom."""

from verify.proof.assistant.stated import Shipped
from verify.proof.checked.in_theory.applies import Applies, eta_of, for_every
from verify.proof.checked.proved import Proved


def _says(proved: Proved) -> str:
    eta = eta_of(proved) or 0
    by = "D" if proved.timed else "X"
    return (
        f"{for_every(proved)} det J − 1 has no term below `h^{eta + 1}`, and that with "
        f"`h^{eta + 1}` has the coefficient −div(`{by}^{eta}` f)/{eta + 1}!"
    )


APPLIES = Applies(
    about="volume",
    applies=lambda proved: eta_of(proved) is not None and proved.preserves is not True,
    theorems=lambda _: (Shipped("Theorems", "determinant_of_lie"),),
    says=_says,
)
