"""The observables that a run can compute, in the plane and in n degrees of freedom."""

from collections.abc import Sequence

from verify import observables
from verify.errors import InputError, unknown_name
from verify.hamiltonians.hamiltonian import Hamiltonian

_KINDS = observables.by_name()
_BY_PLACE = sorted((each.usual, name) for name, each in _KINDS.items() if each.usual is not None)
_USUAL = tuple(name for _, name in _BY_PLACE)
CLOSED_FORM = tuple(name for name in _USUAL if not _KINDS[name].in_plane)
# With the plain way, which is of interest in float64.
REPORTED = (*CLOSED_FORM, "lambda_plain")


def names(*, planar: bool) -> tuple[str, ...]:
    """Return the names of all observables in the plane, or in any number of degrees of freedom."""
    fits = (lambda x: not x.in_plane) if planar else (lambda x: x.most_degrees != 1)
    return tuple(name for name, each in _KINDS.items() if fits(each))


def select_observables(
    hamiltonian: Hamiltonian, requested: Sequence[str] | None
) -> tuple[str, ...]:
    """Return the requested observables; by default ΔJ, MSE, Λ, and S and W where these differ."""
    if requested is not None:
        return tuple(requested)
    return tuple(name for name in _USUAL if carries(hamiltonian, name))


def accumulated_observables(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """Return the observables of all steps together: Λ, and W where it differs and is carried."""
    usual = select_observables(hamiltonian, None)
    return tuple(name for name in ("lambda", "symplectic_defect") if name in usual)


def carries_defect(hamiltonian: Hamiltonian) -> bool:
    """Return True if W, in the plane Λ, is carried in H's number of degrees of freedom."""
    return carries(hamiltonian, hamiltonian.structure.of_run)


def carries(hamiltonian: Hamiltonian, name: str) -> bool:
    """Return True if the observable is carried for such an H and repeats none of the plane."""
    observable = _KINDS[name]
    return observable.fits(hamiltonian.degrees) and not (observable.in_plane and hamiltonian.planar)


def check_observables(hamiltonian: Hamiltonian, requested: Sequence[str]) -> None:
    """Raise InputError for a name that does not exist, or that is not for such an H."""
    available = names(planar=hamiltonian.planar)
    for name in requested:
        observable = _KINDS.get(name)
        if observable and observable.in_plane and name not in available:
            problem = f"is |{observable.in_plane}| in one degree of freedom; ask for it"
            raise InputError("observable", name, problem)
        if observable is None or name not in available:
            raise unknown_name("observable", name, available)
        if hamiltonian.time_dependent and not observable.timed:
            raise InputError("observable", name, "is for an H that does not depend on t")
        if not observable.fits(hamiltonian.degrees):
            most = observable.most_degrees
            problem = f"is for up to {most} degrees of freedom; H has {hamiltonian.degrees}"
            raise InputError("observable", name, problem)
