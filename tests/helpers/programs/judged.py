"""A user's step or map to its finding, as the commands do it."""

from collections.abc import Callable
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.survey import NO_REQUEST, Request
from verify.integrators.results import NO_CLAIMS, Claims, Finding
from verify.integrators.step_check import check_step
from verify.integrators.user_code.loading import callee_from, foreign_callee
from verify.integrators.user_code.user_map import UserMap

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")


def judged(
    function: Callable[..., Any] | UserMap,
    claims: Claims = NO_CLAIMS,
    limit: float = 20,
    hamiltonian: Hamiltonian | str = PENDULUM,
    request: Request = NO_REQUEST,
    arguments: str | None = None,
) -> Finding:
    """What `verify check-integrator` finds of the function, or of a library's or program's step."""
    exact = Hamiltonian.parse(hamiltonian) if isinstance(hamiltonian, str) else hamiltonian
    if isinstance(function, UserMap):
        return check_step(foreign_callee(function), exact, claims, (), request)
    callee = callee_from(
        function, exact.coordinates, arguments=arguments, parameters=dict(exact.values),
        time_limit=limit,
    )  # fmt: skip
    return check_step(callee, exact, claims, (), request)
