"""What a run may be asked for, in the plane and in n degrees of freedom."""

from collections.abc import Sequence

from verify import observables
from verify.errors import InputError, unknown
from verify.hamiltonians.hamiltonian import Hamiltonian

_EVERY = observables.by_name()
_BY_PLACE = sorted((each.usual, name) for name, each in _EVERY.items() if each.usual is not None)
_USUAL = tuple(name for _, name in _BY_PLACE)
CLOSED_FORM = tuple(name for name in _USUAL if not _EVERY[name].in_plane)
REPORTED = (*CLOSED_FORM, "lambda_plain")  # of float64, whose plain way is what is looked at


def names(*, planar: bool) -> tuple[str, ...]:
    """All that may be asked for in the plane, or in some number of degrees of freedom."""
    fits = (lambda x: not x.in_plane) if planar else (lambda x: x.most_degrees != 1)
    return tuple(name for name, each in _EVERY.items() if fits(each))


def observed(hamiltonian: Hamiltonian, asked: Sequence[str] | None) -> tuple[str, ...]:
    """What is asked for; where it is left out, ΔJ, MSE and Λ, and S and W where they are more."""
    if asked is not None:
        return tuple(asked)
    return tuple(name for name in _USUAL if carries(hamiltonian, name))


def accumulated(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """What all steps together do: Λ, and W where that is more, and is carried."""
    usual = observed(hamiltonian, None)
    return tuple(name for name in ("lambda", "symplectic_defect") if name in usual)


def carries_defect(hamiltonian: Hamiltonian) -> bool:
    """Whether W is carried in so many degrees of freedom, or Λ, which it is in the plane."""
    return carries(hamiltonian, hamiltonian.structure.of_run)


def carries(hamiltonian: Hamiltonian, name: str) -> bool:
    """Whether an observable is carried of such an H, and is no other one's in the plane."""
    each = _EVERY[name]
    return each.fits(hamiltonian.degrees) and not (each.in_plane and hamiltonian.planar)


def check_observables(hamiltonian: Hamiltonian, asked: Sequence[str]) -> None:
    """InputError for a name that there is not, or that is not for such an H."""
    there = names(planar=hamiltonian.planar)
    for name in asked:
        each = _EVERY.get(name)
        if each and each.in_plane and name not in there:
            problem = f"is |{each.in_plane}| in one degree of freedom; ask for it"
            raise InputError("observable", name, problem)
        if each is None or name not in there:
            raise unknown("observable", name, there)
        if hamiltonian.time_dependent and not each.timed:
            raise InputError("observable", name, "is for an H that does not depend on t")
        if not each.fits(hamiltonian.degrees):
            most = each.most_degrees
            problem = f"is for up to {most} degrees of freedom; H has {hamiltonian.degrees}"
            raise InputError("observable", name, problem)
