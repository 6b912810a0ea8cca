"""H as an element of the ring of its vector field, in the plane and in n degrees of freedom."""

from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian


def energy_of(hamiltonian: Hamiltonian) -> tuple[Ring, Poly]:
    """The ring, and H in it."""
    if hamiltonian.planar:
        plane, _ = hamiltonian.field()
        return plane.ring, plane.energy
    field, _ = canonical_field(hamiltonian)
    return field.ring, field.energy
