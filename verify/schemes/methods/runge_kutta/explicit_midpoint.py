"""The explicit midpoint rule, Runge's scheme of order 2: z' = z + h f(z + (h/2) f(z))."""

from fractions import Fraction

from verify.schemes.every_hamiltonian import RungeKutta
from verify.schemes.runge_kutta import Tableau, runge_kutta_map
from verify.schemes.scheme import Scheme

EXAMPLES = ("explicit-midpoint",)
_TABLEAU = Tableau(rows=((), (Fraction(1, 2),)), weights=(Fraction(0), Fraction(1)))


def make(name: str) -> Scheme | None:
    if name not in EXAMPLES:
        return None
    return Scheme(
        name=name,
        order=2,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.1",
        build=lambda hamiltonian: runge_kutta_map(hamiltonian, _TABLEAU),
        every_h=RungeKutta(_TABLEAU.rows, _TABLEAU.weights),
    )
