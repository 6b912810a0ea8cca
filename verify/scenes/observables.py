"""The observables that a run can compute, in the plane and in n degrees of freedom."""

from collections.abc import Sequence

from verify import observables
from verify.algebra.formula import parse
from verify.errors import InputError, unknown_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.observables.observable import ENERGY, Observable
from verify.structures.accumulated import read_accumulated

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
        kinds = zip(requested, map(_find, requested), strict=True)
        return tuple(kind.name if kind else name for name, kind in kinds)
    return tuple(name for name in _USUAL if carries(hamiltonian, name))


def observables_aside(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """Return the observables that a run shows beside those that it is asked for: H − H₀."""
    has_energy = hamiltonian.has_energy and not hamiltonian.time_dependent
    return tuple(name for name, each in _KINDS.items() if each.aside and has_energy)


def accumulated_observables(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """Return the observables of all steps together: Λ, and W where it differs and is carried."""
    usual = select_observables(hamiltonian, None)
    return tuple(name for name in ("lambda", "symplectic_defect") if name in usual)


def carries_defect(hamiltonian: Hamiltonian) -> bool:
    """Return True if W, in the plane Λ, is carried in H's number of degrees of freedom."""
    return carries(hamiltonian, hamiltonian.structure.of_run)


def carries(hamiltonian: Hamiltonian, name: str) -> bool:
    """Return True if a run carries the observable for such an H, and it repeats none of the
    plane."""
    observable = _find(name)
    if observable is None or not observable.of_one_run:
        return False
    if hamiltonian.planar and observable.in_plane:
        return False
    is_of = hamiltonian.has_energy or observable.of_any_field
    return is_of and observable.fits(_pairs(hamiltonian))


def _pairs(hamiltonian: Hamiltonian) -> int:
    """Return half the number of coordinates, rounded up."""
    return -(-len(hamiltonian.coordinates) // 2)


def check_observables(hamiltonian: Hamiltonian, requested: Sequence[str]) -> None:
    """Raise InputError for a name that does not exist, or that is not for such an H."""
    available = names(planar=hamiltonian.planar)
    if not hamiltonian.has_energy:
        available = tuple(name for name in available if _KINDS[name].of_any_field)
    for name in requested:
        observable = _find(name)
        if observable and observable.in_plane and name not in available:
            problem = f"is |{observable.in_plane}| in one degree of freedom; ask for it"
            raise InputError("observable", name, problem)
        if observable is None or (name in _KINDS and name not in available):
            raise unknown_name("observable", name, available)
        if hamiltonian.time_dependent and not observable.timed:
            raise InputError("observable", name, "is for an H that does not depend on t")
        if not observable.fits(_pairs(hamiltonian)):
            most = observable.most_degrees or 0
            problem = f"is for up to {most} degrees of freedom; H has {hamiltonian.degrees}"
            if not hamiltonian.has_energy:
                count = len(hamiltonian.coordinates)
                problem = f"is for up to {2 * most} coordinates, and there are {count}"
            raise InputError("observable", name, problem)
        if observable.integral not in ("", ENERGY):
            time = ("t",) if hamiltonian.time_dependent else ()
            parse(observable.integral, (*hamiltonian.coordinates, *time), source="observable")
        if observable.structure:
            read_accumulated(observable.structure, hamiltonian)


def _find(name: object) -> Observable | None:
    return observables.find(name) if isinstance(name, str) else None
