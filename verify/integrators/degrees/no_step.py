"""What is said of a step of arrays that returns no state at any point, or more than one."""

from collections.abc import Sequence
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.defined import UNDEFINED, first_defined
from verify.integrators.degrees.called import StepAt
from verify.integrators.maps.check import NotAFunctionError
from verify.integrators.maps.probes import FloatProbe
from verify.integrators.maps.user_map import flat
from verify.integrators.step import StepError, last_line, why
from verify.prose import Number, Prose, joined, prose
from verify.verdict import Verdict

Point = tuple[Fraction, ...]


def judged_without_call(
    here: StepAt, hamiltonian: Hamiltonian, points: Sequence[Point], error: Exception
) -> tuple[Verdict, Prose]:
    """REFUTED, as it is in the plane, with the point; `error` is what was raised at the first one.

    UNDECIDED where that says nothing against the method: it ran out of time, it is for lists, or H
    is defined at none of the points either.
    """
    if isinstance(error, NotAFunctionError):
        return Verdict.REFUTED, prose(error.said)
    if here.own.step.left <= 0:
        return Verdict.UNDECIDED, prose(why(error))
    point = first_defined(hamiltonian, points, here.h, here.t)
    if point is None:
        return Verdict.UNDECIDED, prose(why(error), UNDEFINED)
    try:
        FloatProbe(here).value(point)
    except Exception as raised:  # the user's code may raise anything
        error = raised
    else:
        return Verdict.UNDECIDED, prose(why(error), ", and once not")
    if _takes_lists(here, point):
        said = prose(why(error), ", of arrays, and takes lists; wanted: numpy arrays p, q")
        return Verdict.UNDECIDED, said
    raises = not isinstance(error, StepError)
    said = prose(f"it raises {last_line(error)}") if raises else prose(why(error))
    return Verdict.REFUTED, prose(said, "" if here.own.step.foreign else _place(here, point))


def _takes_lists(here: StepAt, point: Point) -> bool:
    n, step = len(point) // 2, here.own.step
    p, q = ([float(x) for x in part] for part in (point[:n], point[n:]))
    if step.foreign:
        return False
    try:
        with step.limited():
            flat(step.raw(step.function, p, q, float(here.h), float(here.t)), 2 * n)
    except Exception:  # as above
        return False
    return True


def _place(here: StepAt, point: Point) -> Prose:
    n = len(point) // 2
    p, q = (
        joined(", ", (Number(f"{float(x):g}") for x in part)) for part in (point[:n], point[n:])
    )
    return prose(" at p = (", p, "), q = (", q, "), h = ", Number(f"{float(here.h):g}"))
