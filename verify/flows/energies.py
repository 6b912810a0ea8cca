"""H at points, to so many digits."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import mpfr
from verify.flows.functions import Function, defined_values, functions_at
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian


def energies_at(
    hamiltonian: Hamiltonian, digits: int, columns: Sequence[Sequence[Any]]
) -> list[Any]:
    """H to so many digits at points, given by each coordinate's numbers, as `defined_values` has
    them: numbers of MPFR, or None where it is not defined or too large."""
    return defined_values(*_energy(hamiltonian, digits), columns)


@lru_cache(maxsize=64)
def _energy(hamiltonian: Hamiltonian, digits: int) -> tuple[Arithmetic, Function]:
    """What H is evaluated in, and H as a function of the coordinates; runs of one H share it."""
    arithmetic = mpfr.make(digits)
    return arithmetic, functions_at(arithmetic, [energy_of(hamiltonian)], hamiltonian.coordinates)
