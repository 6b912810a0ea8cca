"""The classical Runge–Kutta scheme, four stages, order 4."""

from fractions import Fraction

from verify.schemes.every_hamiltonian import RungeKutta
from verify.schemes.runge_kutta import Tableau, runge_kutta_map
from verify.schemes.scheme import Scheme

EXAMPLES = ("rk4",)
_ZERO, _HALF, _ONE = Fraction(0), Fraction(1, 2), Fraction(1)
_TABLEAU = Tableau(
    rows=((), (_HALF,), (_ZERO, _HALF), (_ZERO, _ZERO, _ONE)),
    weights=(_ONE / 6, _ONE / 3, _ONE / 3, _ONE / 6),
)


def make(name: str) -> Scheme | None:
    if name not in EXAMPLES:
        return None
    return Scheme(
        name=name,
        order=4,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.1",
        build=lambda hamiltonian: runge_kutta_map(hamiltonian, _TABLEAU),
        every_h=RungeKutta(_TABLEAU.rows, _TABLEAU.weights),
    )
