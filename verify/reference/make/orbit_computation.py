"""One orbit at chosen steps, and the exact flow at their times, every number correctly rounded.

Each chosen step is a run of its own, so that the numbers are those that
`verify.runs.requested_run` reports, with a rigorous bound wherever there is one. ΔJ at the state,
or H in several degrees of freedom, is enclosed by balls over all states within that bound. The
number of digits is raised until all numbers round to one decimal.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from typing import Any

import flint

from verify.algebra.enclosure import enclose_all, enclose_over
from verify.arithmetic.arb import is_representable, make_ball, midpoint_and_radius, rational_ball
from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import ExactSolution, leaves_by_algebra, solution_from
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.lockstep import Course
from verify.reference.make.row_values import (
    AFTER_A_STEP,
    MAY_LACK,
    correctly_rounded,
    near_zero,
    orbit_columns,
)
from verify.runs.requested_run import RequestedRun
from verify.runs.run_start import Start
from verify.scenes.results import reference
from verify.scenes.values import AUTO
from verify.schemes.maps.ball_algebra import UndefinedError, step_in_balls
from verify.structures import AREA, SYMPLECTIC

_GUARDS = (10, 25, 60, 150)  # digits beyond those asked for, in turn
_BITS = 64  # beyond the digits, for the roundings of one step, or of H
_ORBITS = {AREA: reference.OrbitPoint, SYMPLECTIC: reference.OrbitPointInDegrees}
_FLOWS = {AREA: reference.FlowPoint, SYMPLECTIC: reference.FlowPointInDegrees}
_UNKNOWN: dict[str, Any] = {"status": "unresolved", "kind": None, "failed_step": None}
Bounded = tuple[Fraction, Fraction]  # a value and its bound
Numbers = Mapping[str, reference.Rounded | None]  # by the names of their columns


def orbit_points(orbit: Start, steps: Sequence[int], digits: int) -> Course[tuple[Any, ...]]:
    """Compute the orbit after each of these numbers of steps, every number to so many digits."""
    hamiltonian, points = orbit.hamiltonian, []
    for step in steps:
        status, values = yield from _point_after(orbit, step, digits)
        numbers = _state(values)
        numbers |= {name: values.get(name) for name in orbit_columns(hamiltonian.degrees)}
        points.append(_ORBITS[hamiltonian.structure](step=step, **_UNKNOWN | status, **numbers))
    return tuple(points)


def _point_after(orbit: Start, step: int, digits: int) -> Course[tuple[dict[str, Any], Numbers]]:
    """Return the status after so many steps, and the numbers, if there are any.

    A number that lies between two decimals within its bound has no rounding yet: then all are
    computed again with more digits.
    """
    start = orbit.point
    columns = orbit_columns(orbit.hamiltonian.degrees)
    observables = tuple(x for x in columns if x not in MAY_LACK)
    at_first = [x for x in observables if x not in AFTER_A_STEP]
    for guard in _GUARDS:
        bounded = {name: (x, Fraction(0)) for name, x in start.items()}
        bounded |= dict.fromkeys(at_first, (Fraction(0), Fraction(0)))
        kind: reference.Kind = "enclosed"
        if step > 0:
            request = RequestedRun(
                **orbit.run_arguments,
                steps=step,
                arithmetic=AUTO,
                digits=digits + guard,
                observables=observables,
            )
            after = yield from request.result()
            if after.status == "left range":
                return {"status": "left range", "failed_step": after.failed_step}, {}
            if after.status == "unresolved":
                break
            kind = after.error_kind
            bounded = {n: (Fraction(v.value), Fraction(v.bound)) for n, v in after.values.items()}
        bounded |= _enclose_at_state(orbit, step, bounded, digits + guard)
        values = _round_all(bounded, start, digits, guard)
        if all(values.values()):
            return {"status": "finished", "kind": kind}, values
    return {}, {}


def _round_all(
    bounded: Mapping[str, Bounded], start: Mapping[str, Fraction], digits: int, guard: int
) -> dict[str, reference.Rounded | None]:
    """Round each number; with the last guard a 0 too, coordinates against the initial value."""
    largest = max(map(abs, start.values()))
    values = {name: correctly_rounded(*x, digits) for name, x in bounded.items()}
    if guard == _GUARDS[-1]:
        for name, x in bounded.items():
            size = largest if name in start else Fraction(1)
            values[name] = values[name] or near_zero(*x, digits, size)
    return values


def _state(values: Numbers) -> dict[str, Any]:
    """Return p and q of a row: a number each, or a list; None if there are none."""
    lists = {letter: tuple(values[x] for x in values if x[0] == letter != x) for letter in "pq"}
    return {letter: values.get(letter) or several or None for letter, several in lists.items()}


def _enclose_at_state(
    orbit: Start, step: int, bounded: Mapping[str, Bounded], digits: int
) -> dict[str, Bounded]:
    """Enclose ΔJ of the orbit's next step after so many, or H in several degrees of freedom,
    from any state within the bounds in `bounded`; empty if it may not be defined there."""
    with working_precision(4 * digits + _BITS):
        box = {name: make_ball(*bounded[name]) for name in orbit.hamiltonian.coordinates}
        if orbit.hamiltonian.time_dependent:
            box["t"] = rational_ball(orbit.t0 + step * orbit.step_size)
        (name,) = (x for x in orbit_columns(orbit.hamiltonian.degrees) if x in MAY_LACK)
        value = _delta_j(orbit, box) if name == "delta_j" else _energy(orbit, box)
        return (
            {name: midpoint_and_radius(value)}
            if value is not None and is_representable(value)
            else {}
        )


def _energy(orbit: Start, box: dict[str, flint.arb]) -> flint.arb | None:
    field, _ = canonical_field(orbit.hamiltonian)
    return enclose_over(field.ring, field.energy, box)


def _delta_j(orbit: Start, box: dict[str, flint.arb]) -> flint.arb | None:
    """Enclose ΔJ; None, too, if a step is given by equations and is not proved to preserve
    area."""
    step_map = step_map_of(orbit.hamiltonian, orbit.scheme)
    if step_map.preserves_area:
        return flint.arb(0)
    h, closed_defect = rational_ball(orbit.step_size), step_map.written_defect
    if closed_defect is not None:
        # With z' itself, since ΔJ may be defined beyond H.
        balls = enclose_all(
            closed_defect.ring, [closed_defect.delta_j, *closed_defect.elements], {**box, "h": h}
        )
        return None if balls is None else balls[0]
    try:
        _, slopes = step_in_balls(step_map.field, step_map.step or step_map.flat, box, h)
    except UndefinedError:
        return None
    (a, b), (c, d) = slopes.tolist()
    # With J = 1 + (slopes), det J − 1 is expanded so that the two 1's do not cancel.
    change: flint.arb = a + d + a * d - b * c
    return change


# -- the exact flow ----------------------------------------------------------------------------


def solution_points(
    hamiltonian: Hamiltonian,
    start: Mapping[str, Fraction],
    t0: Fraction,
    times: Mapping[int, Fraction],
    digits: int,
) -> Iterator[Any]:
    """Yield the exact flow from the coordinates in `start` and t0, at these times after it by
    their N, to so many digits."""
    model = _FLOWS[hamiltonian.structure]
    for step, time in times.items():
        status, kind, values = _solution_at(hamiltonian, start, t0, time, digits)
        state: dict[str, Any] = {"status": status, "kind": kind, **_state(values)}
        yield model(step=step, time=text(time), **state)


def _solution_at(
    hamiltonian: Hamiltonian,
    start: Mapping[str, Fraction],
    t0: Fraction,
    time: Fraction,
    digits: int,
) -> tuple[str, reference.Kind | None, Numbers]:
    """Return the status of a row of the exact flow, the kind of its radii, and its values."""
    try:
        for guard in _GUARDS:
            if time == 0:  # the initial value itself, also where H is not defined
                solution = ExactSolution(start, Fraction(0), "the initial value itself")
            else:
                solution = solution_from(hamiltonian, start, time, digits + guard, t0)
            bounded = {name: (x, solution.bound) for name, x in solution.point.items()}
            values = _round_all(bounded, start, digits, guard)
            if all(values.values()):
                return "finished", "enclosed" if solution.enclosed else "estimated", values
    except InputError as error:
        if error.name != "digits":
            raise
    except NoFlowError:
        if _blows_up(hamiltonian, start, time):
            return "blows up", None, {}
    return "not followed", None, {}


def _blows_up(hamiltonian: Hamiltonian, start: Mapping[str, Fraction], time: Fraction) -> bool:
    """Return True if algebra proves a blow-up, which it does in the plane alone."""
    if not hamiltonian.planar or hamiltonian.time_dependent:
        return False
    with suppress(NoFlowError):  # H may not even be defined at the initial value
        reason = leaves_by_algebra(hamiltonian, p=start["p"], q=start["q"], time=time)
        return reason is not None and reason.startswith("it blows up")
    return False
