"""Where a run may start: where H is defined and smooth."""

from verify.arithmetic.exact import Exact, rational, text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian


def check_start(hamiltonian: Hamiltonian, q: Exact, p: Exact, t0: Exact = 0) -> None:
    """InputError where H is not defined, or not smooth, at (q, p), and at t0 where it depends on
    time.

    >>> check_start(Hamiltonian.parse("p**2/2 + log(q)"), -1, 0)
    Traceback (most recent call last):
    verify.errors.InputError: q, p=-1, 0: H is not smooth there; it is where q > 0
    """
    point = {"q": rational(q, "q"), "p": rational(p, "p")}
    if hamiltonian.time_dependent:
        point["t"] = rational(t0, "t0")
    domain = hamiltonian.domain
    if domain.names <= set(point) and domain.contains(point) is False:
        shown = ", ".join(map(text, point.values()))
        problem = f"H is not smooth there; it is where {', '.join(domain.texts)}"
        raise InputError(", ".join(point), shown, problem)
