"""pyhamsys's splittings, as steps: compositions of two maps chi and chi_star that a user gives.

The README says of some whether chi is exp(h X_A) exp(h X_B) or the other way round, with A = A(p)
and B = B(q); the operators are read as acting in their order on (q, p), the first first, as the
orders ask for. All others are for either.
"""

import itertools
from collections.abc import Iterator

from verify.audits.methods import driver
from verify.audits.methods.integrator import ReleasedIntegrator, table_integrator, text

TITLE = "pyhamsys"
LIBRARY = "pyhamsys"
LEFT_OUT = (
    ("solve_ivp_sympext", "steps in an extended space, of twice the dimension"),
    ("RK23 … LSODA", "are scipy's"),
    ("methods of order 6 and 8 in the plane, as steps", "are judged by their tables"),
    (
        "PEFRL, VEFRL, RKN… with a force that depends on time",
        "which time their chi reads is not said, and their order may ask for it",
    ),
)
# From this order on methods are judged by their tables: float64 does not show it in the plane.
_HIGH_ORDER = 6
_HEAD = """\
import numpy as np
from pyhamsys.pyhamsys import SymplecticIntegrator


def drift(h, t, q, p):
    return q + h * p, p


def kick(h, t, q, p):
    return q, p + h * force(t, q)
"""
_BODY = """\
def chi(h, t, y):
    return np.concatenate({second}(h, t, *{first}(h, t, *np.split(y, 2))))
def chi_star(h, t, y):
    return np.concatenate({first}(h, t, *{second}(h, t, *np.split(y, 2))))
y = np.hstack([q, p])
_, y = SymplecticIntegrator("{method}", h)._integrate_onestep(t, y, chi, chi_star)
q, p = np.split(y, 2)
"""
_EITHER = {
    "Verlet": 2, "FR": 4, "Yo6": 6, "Yo8": 8, "Yos6": 6, "M2": 2, "M4": 4, "BM4": 4, "BM6": 6,
    "EFRL": 4, "ABA104": 4, "ABA864": 4, "ABA1064": 4,
}  # fmt: skip
_OF_KICKS = {"PEFRL": 4, "RKN6a": 6}
_OF_DRIFTS = {"VEFRL": 4, "RKN4b": 4, "RKN6b": 6}


def _driven(first: str, second: str) -> driver.Driver:
    body = _BODY.replace("{first}", first).replace("{second}", second)
    description = f"one step of the integrator, chi a {first} and then a {second}"
    return driver.Driver(_HEAD, body, description)


def integrators() -> Iterator[ReleasedIntegrator]:
    for orders, first, second, problems in (
        (_EITHER, "drift", "kick", driver.PROBLEMS),
        (_OF_KICKS, "drift", "kick", (driver.TWO_WAVES, driver.HENON_HEILES)),
        (_OF_DRIFTS, "kick", "drift", (driver.TWO_WAVES, driver.HENON_HEILES)),
    ):
        driven = _driven(first, second)
        for method, order in orders.items():
            source = f"its README, “{method} (order {order}…”; autonomous and non-autonomous"
            yield _table(method, order, source, first)
            selected_problems = problems if order < _HIGH_ORDER else problems[1:2]
            yield from driver.drive_problems(
                f"{method}, as a step", driven, method, source, order, True, selected_problems
            )


def _table(method: str, order: int, source: str, first: str) -> ReleasedIntegrator:
    """Build the table, in which the parts of a chi and the chi_star that follows are merged."""
    from pyhamsys.pyhamsys import SymplecticIntegrator

    shares = [text(float(x)) for x, _ in SymplecticIntegrator(method, 1.0)._sequence]
    # chi and the chi_star after it begin and end with the same kind of part, so that these two
    # parts are one.
    between = [f"({x})+({y})" for x, y in itertools.pairwise(shares)]
    kind = "splitting" if method in _EITHER and method != "EFRL" else "nystrom"
    return table_integrator(
        method, kind, f"the integrator's sequence, chi a {first} first", source,
        order=order, first=first, sizes=[shares[0], *between, shares[-1]], symplectic=True,
    )  # fmt: skip
