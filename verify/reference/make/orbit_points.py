"""One orbit at chosen steps, and the exact flow at their times, every number correctly rounded.

Each step that is chosen is a run of its own, so that what is known of it is what `verify.runs.run`
reports, with a rigorous bound wherever one can be had. ΔJ at the state is enclosed by balls over
all states within that bound. More digits are asked for until all numbers round to one decimal.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from types import MappingProxyType
from typing import Literal

import flint

from verify.algebra.enclosure import enclose_all
from verify.arithmetic.arb import around, in_reach, middle_and_radius, rational_ball
from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.flows.extrapolation import NoFlowError
from verify.flows.solution import Solution, exact_solution, leaves_by_algebra
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.orbit import Orbit
from verify.kernels.step.computation import step_map_of
from verify.reference.make.correct_rounding import correctly_rounded, near_zero
from verify.reference.make.models import VALUES
from verify.runs.run import run
from verify.scenes.results.reference import (
    FlowPoint,
    Kind,
    OrbitPoint,
    OrbitResult,
    Rounded,
    SolutionResult,
)
from verify.scenes.results.run import RunResult
from verify.scenes.values import AUTO
from verify.schemes.step_map import StepMap

GUARDS = (10, 25, 60, 150)  # digits beyond those asked for, in turn
_BITS = 64  # beyond the digits, for the roundings of one step
_ZERO = Fraction(0), Fraction(0)
Bounded = tuple[Fraction, Fraction]  # a value and its bound


def orbit_points(orbit: Orbit, *, steps: Sequence[int], digits: int) -> OrbitResult:
    """The orbit after each of these numbers of steps, every number to so many digits."""
    return OrbitResult(points=tuple(_point(orbit, n, digits) for n in steps))


def _point(orbit: Orbit, step: int, digits: int) -> OrbitPoint:
    step_map = step_map_of(orbit.hamiltonian, orbit.scheme)
    for guard in GUARDS:
        known = {"p": (orbit.p, Fraction(0)), "q": (orbit.q, Fraction(0)), "lambda": _ZERO}
        kind: Kind = "enclosed"
        if step > 0:
            found = _run(orbit, step, digits + guard)
            if found.status == "left range":
                return _orbit_point(step, "left range", failed_step=found.failed_step)
            if found.status == "unresolved":
                break
            kind = found.error_kind
            known = {n: (Fraction(v.value), Fraction(v.bound)) for n, v in found.values.items()}
        change = delta_j_at(step_map, known, orbit, step, digits + guard)
        if change is not None:
            known["delta_j"] = change
        last = guard == GUARDS[-1]
        values = {
            n: _rounded(x, digits, last, _size(orbit.q, orbit.p, n)) for n, x in known.items()
        }
        if all(values.values()):
            return _orbit_point(step, "finished", values, kind=kind)
    return _orbit_point(step, "unresolved")


def _run(orbit: Orbit, steps: int, digits: int) -> RunResult:
    return run(
        orbit.hamiltonian,
        orbit.scheme,
        q=orbit.q,
        p=orbit.p,
        step_size=orbit.step_size,
        t0=orbit.t0,
        steps=steps,
        arithmetic=AUTO,
        digits=digits,
        observables=("mse", "lambda"),
    )


def _size(q: Fraction, p: Fraction, name: str = "p") -> Fraction:
    """What a number of that name is small against: p and q against the initial value."""
    return max(abs(p), abs(q)) if name in ("p", "q") else Fraction(1)


def _rounded(known: Bounded, digits: int, last: bool, size: Fraction) -> Rounded | None:
    rounded = correctly_rounded(*known, digits)
    return rounded or (near_zero(*known, digits, size) if last else None)


def _orbit_point(
    step: int,
    status: Literal["finished", "left range", "unresolved"],
    values: Mapping[str, Rounded | None] = MappingProxyType({}),
    kind: Kind | None = None,
    failed_step: int | None = None,
) -> OrbitPoint:
    named = {name: values.get(name) for name in VALUES}
    return OrbitPoint(step=step, status=status, failed_step=failed_step, kind=kind, **named)


def delta_j_at(
    step_map: StepMap, known: Mapping[str, Bounded], orbit: Orbit, step: int, digits: int
) -> Bounded | None:
    """ΔJ of the orbit's next step after so many, from any state within the bounds of p and q in
    `known`: its middle and radius.

    Rigorous. None where a step is given by equations and does not preserve area by proof, and where
    it may not be defined there.
    """
    if step_map.preserves_area:
        return _ZERO
    if step_map.implicit:
        return None
    with working_precision(4 * digits + _BITS):
        box = {name: around(*known[name]) for name in ("p", "q")}
        box |= {"h": rational_ball(orbit.step_size)}
        if orbit.hamiltonian.time_dependent:
            box["t"] = rational_ball(orbit.t0 + step * orbit.step_size)
        total = flint.arb(0)
        for part in step_map.substeps:
            own = enclose_all(part.ring, [part.delta_j, part.p_next, part.q_next], box)
            if own is None:
                return None
            change, box["p"], box["q"] = own
            total = total + change + total * change
        return middle_and_radius(total) if in_reach(total) else None


# -- the exact flow ----------------------------------------------------------------------------


def solution_points(
    hamiltonian: Hamiltonian, start: dict[str, Fraction], times: dict[int, Fraction], digits: int
) -> SolutionResult:
    """The exact flow from q and p, and t0, in `start`, at these times after it by their N, to so
    many digits."""
    points = (_flow_point(hamiltonian, start, *at, digits) for at in times.items())
    return SolutionResult(points=tuple(points))


def _flow_point(
    hamiltonian: Hamiltonian, start: dict[str, Fraction], step: int, time: Fraction, digits: int
) -> FlowPoint:
    try:
        for guard in GUARDS:
            if step == 0:  # the initial value itself, also where H is not defined
                at = Solution(start["p"], start["q"], Fraction(0), "the initial value itself")
            else:
                at = exact_solution(hamiltonian, **start, time=time, digits=digits + guard)
            last = guard == GUARDS[-1]
            size = _size(start["q"], start["p"])
            p, q = (_rounded((x, at.bound), digits, last, size) for x in (at.p, at.q))
            if p and q:
                kind: Kind = "enclosed" if at.enclosed else "estimated"
                return FlowPoint(step=step, time=text(time), status="finished", kind=kind, p=p, q=q)
    except InputError as error:
        if error.name != "digits":
            raise
    except NoFlowError:
        with suppress(NoFlowError):  # H may not even be defined at the initial value
            still = None if hamiltonian.time_dependent else leaves_by_algebra
            told = still and still(hamiltonian, p=start["p"], q=start["q"], time=time)
            if told is not None and told.startswith("it blows up"):
                return _nothing(step, time, "blows up")
    return _nothing(step, time, "not followed")


def _nothing(step: int, time: Fraction, status: Literal["blows up", "not followed"]) -> FlowPoint:
    return FlowPoint(step=step, time=text(time), status=status, kind=None, p=None, q=None)
