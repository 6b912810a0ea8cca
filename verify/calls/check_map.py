"""`verify.check_map`: any map of one's own, without an H: is it symplectic?"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from verify.arithmetic.exact import Exact, positive, rational
from verify.errors import InputError
from verify.hamiltonians.coordinates import check_degrees, coordinates_in
from verify.integrators.check import check_map as check
from verify.integrators.measures.survey import Request
from verify.integrators.results import Finding
from verify.integrators.user_code.loading import callee_from
from verify.integrators.user_code.step import TIME_LIMIT


def check_map(
    function: Callable[..., Any],
    degrees: int = 1,
    *,
    arguments: str | None = None,
    parameters: Mapping[str, Exact] | None = None,
    point: Sequence[Exact] | None = None,
    within: Exact | None = None,
    time_limit: float = TIME_LIMIT,
) -> Finding:
    """Whether a map of one's own is symplectic, JᵀΩJ = Ω everywhere: proved, else measured.

    Parameters
    ----------
    function: map(p, q) → p', q', of numbers where `degrees` is 1 and of arrays of so many numbers
        else; or map(z) → z' of one array of 2·degrees numbers. It is called.
    arguments: where the coordinates stand in z, such as "q1,p1,q2,p2"; else p1, …, pn, q1, …, qn.
    parameters: further arguments that it takes by name, exact.
    point: p1, …, pn, q1, …, qn of a point to look at first; `within`: a defect that is allowed;
        `time_limit`: seconds for all calls.

    Raises InputError, one line.

    >>> found = check_map(lambda p, q: ([p[0] - q[1], p[1] - q[0]], q), degrees=2)
    >>> str(found.verdict), found.symplectic
    ('PROVED', True)
    >>> found = check_map(lambda p, q: ([2 * p[0], p[1]], [q[0], q[1] / 2]), degrees=2)
    >>> str(found.verdict), found.entry, found.area_preserving
    ('REFUTED', 'dp1∧dq1', True)
    """
    if not callable(function):
        raise InputError("map", function, "is no function; wanted: map(p, q), which returns p', q'")
    check_degrees(degrees)
    names = coordinates_in(degrees)
    values = {n: rational(x, f"parameter {n}") for n, x in (parameters or {}).items()}
    callee = callee_from(
        function, names, stepped=False, arguments=arguments, parameters=values, strict=True,
        time_limit=time_limit,
    )  # fmt: skip
    z = None
    if point is not None:
        z = tuple(rational(x, "point") for x in point)
        if len(z) != len(names):
            raise InputError("point", point, f"has {len(z)} numbers; allowed: {len(names)}")
    allowed = None if within is None else positive(within, "within")
    return check(callee, Request(z=z, within=allowed))
