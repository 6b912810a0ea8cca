"""An H for which a scheme does not preserve area, where conditions that suffice for it fail."""

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order import leading_of
from verify.schemes.scheme import Scheme

# Polynomials, so that all is decided; with cubic terms, as a quadratic H makes too much vanish.
_SEPARABLE = ("p**2/2 + q**2/2 + q**3/3", "p**2/2 + p**3/3 + q**2/2 + q**4/4 + q**3/3")
_OTHERS = ("p**2/2 + q**2/2 + p*q**2 + q**3/3",)


def counterexample(scheme: Scheme, separable: bool) -> tuple[str, int] | None:
    """The H as a formula and the order of ΔJ for it, exact; None where none is found."""
    for text in (*_SEPARABLE, *(() if separable else _OTHERS)):
        try:
            step_map = scheme.step_map(Hamiltonian.parse(text))
        except InputError:
            continue
        leading = leading_of(step_map)
        if leading.decision.zero is False and leading.power is not None:
            return text, leading.power
    return None
