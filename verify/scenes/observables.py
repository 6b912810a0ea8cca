"""What a run may be asked for, in the plane and in n degrees of freedom."""

from collections.abc import Sequence

from verify.errors import InputError, unknown
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.values import CLOSED_FORM, OBSERVABLES

# In n degrees of freedom S is no longer ΔJ times Ω.
OF_FORM = ("symplectic_defect_max", "symplectic_defect")
# Made of S, or of ΔJ, alone, and 0 after every step where that vanishes.
OF_DEFECT = (*OF_FORM, *CLOSED_FORM, "lambda_max")
SEVERAL = OF_DEFECT
_USUAL = (*OF_FORM, *CLOSED_FORM)
# By the operations of a step: S has n(2n − 1) entries, det J is a Pfaffian, W is made of products
# of matrices.
_MOST_DEGREES = {"symplectic_defect_max": 8, "symplectic_defect": 4, "mse": 4, "delta_j_max": 4,
                 "lambda": 4, "lambda_max": 4}  # fmt: skip


def observed(hamiltonian: Hamiltonian, asked: Sequence[str] | None) -> tuple[str, ...]:
    """What is asked for; where it is left out, ΔJ, MSE and Λ, and S and W where they are more."""
    if asked is not None:
        return tuple(asked)
    if hamiltonian.planar:
        return CLOSED_FORM
    return tuple(name for name in _USUAL if hamiltonian.degrees <= _MOST_DEGREES[name])


def carries_defect(hamiltonian: Hamiltonian) -> bool:
    """Whether W is carried in so many degrees of freedom."""
    return hamiltonian.degrees <= _MOST_DEGREES["symplectic_defect"]


def check_observables(hamiltonian: Hamiltonian, asked: Sequence[str]) -> None:
    """InputError for a name that there is not, or that is not for so many degrees of freedom."""
    known, degrees = OBSERVABLES if hamiltonian.planar else SEVERAL, hamiltonian.degrees
    for name in asked:
        if hamiltonian.planar and name in OF_FORM:
            same = {"symplectic_defect_max": "delta_j_max", "symplectic_defect": "lambda"}[name]
            raise InputError(
                "observable", name, f"is |{same}| in one degree of freedom; ask for it"
            )
        if name not in known:
            raise unknown("observable", name, known)
        if degrees > _MOST_DEGREES.get(name, degrees):
            problem = f"is for up to {_MOST_DEGREES[name]} degrees of freedom; H has {degrees}"
            raise InputError("observable", name, problem)
