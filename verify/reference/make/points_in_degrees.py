"""One orbit in n degrees of freedom at chosen steps, and the exact flow, correctly rounded.

As `verify.reference.make.orbit_points` in the plane: each chosen step is a run of its own, and more
digits are asked for until all numbers round to one decimal. H is enclosed by balls over all states
within the bounds of the run.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Literal

from verify.algebra.enclosure import enclose_over
from verify.arithmetic.arb import around, in_reach, middle_and_radius, rational_ball
from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.errors import InputError
from verify.flows.degrees.solution import solution_in_degrees
from verify.flows.extrapolation import NoFlowError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import point_of
from verify.reference.make.correct_rounding import correctly_rounded, near_zero
from verify.reference.make.models_in_degrees import OF_ORBIT
from verify.reference.make.orbit_points import GUARDS, Bounded
from verify.runs.run import run
from verify.scenes.results.reference import Kind, Rounded
from verify.scenes.results.reference_in_degrees import FlowPointInDegrees, OrbitPointInDegrees
from verify.scenes.values import AUTO

_OBSERVED = ("symplectic_defect_max", "symplectic_defect", "lambda")
_BITS = 64  # beyond the digits, for the roundings of H
_ZERO = Fraction(0), Fraction(0)


@dataclass(frozen=True)
class OrbitInDegrees:
    """The iterates of a scheme's step of one size from (q, p), at t0 where H depends on time."""

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    q: tuple[Fraction, ...]
    p: tuple[Fraction, ...]
    t0: Fraction = Fraction(0)

    @property
    def point(self) -> dict[str, Fraction]:
        """The coordinates at the start, by name."""
        return point_of(self.hamiltonian, self.q, self.p)


def orbit_points(
    orbit: OrbitInDegrees, steps: Sequence[int], digits: int
) -> Iterator[OrbitPointInDegrees]:
    """The orbit after each of these numbers of steps, every number to so many digits."""
    for step in steps:
        yield _point(orbit, step, digits)


def _point(orbit: OrbitInDegrees, step: int, digits: int) -> OrbitPointInDegrees:
    for guard in GUARDS:
        known = {name: (x, Fraction(0)) for name, x in orbit.point.items()}
        known |= dict.fromkeys(_OBSERVED[1:], _ZERO)
        kind: Kind = "enclosed"
        if step > 0:
            found = run(
                orbit.hamiltonian, orbit.scheme, q=orbit.q, p=orbit.p, step_size=orbit.step_size,
                t0=orbit.t0, steps=step, arithmetic=AUTO, digits=digits + guard,
                observables=_OBSERVED,
            )  # fmt: skip
            if found.status == "left range":
                return _made(step, "left range", failed_step=found.failed_step)
            if found.status == "unresolved":
                break
            kind = found.error_kind
            known = {n: (Fraction(v.value), Fraction(v.bound)) for n, v in found.values.items()}
        known |= _energy(orbit, step, known, digits + guard)
        last = guard == GUARDS[-1]
        size = max(map(abs, orbit.point.values()))
        values = {
            name: _rounded(x, digits, last, size if name in orbit.point else Fraction(1))
            for name, x in known.items()
        }
        if all(values.values()):
            return _made(step, "finished", kind=kind, values=values)
    return _made(step, "unresolved")


def _made(
    step: int,
    status: Literal["finished", "left range", "unresolved"],
    *,
    kind: Kind | None = None,
    failed_step: int | None = None,
    values: Mapping[str, Rounded | None] = MappingProxyType({}),
) -> OrbitPointInDegrees:
    own = {name: values.get(name) for name in OF_ORBIT}
    p, q = (_list(values, letter) for letter in "pq")
    return OrbitPointInDegrees(
        step=step, status=status, failed_step=failed_step, kind=kind, p=p, q=q, **own
    )


def _list(values: Mapping[str, Rounded | None], letter: str) -> tuple[Rounded, ...] | None:
    """The values of all p or of all q, in order; None where there are none."""
    count = sum(name[0] == letter and name[1:].isdigit() for name in values)
    each = (values[f"{letter}{k}"] for k in range(1, count + 1))
    return tuple(x for x in each if x is not None) or None


def _rounded(known: Bounded, digits: int, last: bool, size: Fraction) -> Rounded | None:
    rounded = correctly_rounded(*known, digits)
    return rounded or (near_zero(*known, digits, size) if last else None)


def _energy(
    orbit: OrbitInDegrees, step: int, known: Mapping[str, Bounded], digits: int
) -> dict[str, Bounded]:
    """H at any state within the bounds; nothing where it may not be defined there."""
    field, _ = canonical_field(orbit.hamiltonian)
    with working_precision(4 * digits + _BITS):
        box = {name: around(*known[name]) for name in field.names}
        if field.timed:
            box["t"] = rational_ball(orbit.t0 + step * orbit.step_size)
        value = enclose_over(field.ring, field.energy, box)
        if value is None or not in_reach(value):
            return {}
        return {"energy": middle_and_radius(value)}


# -- the exact flow ----------------------------------------------------------------------------


def flow_points(
    hamiltonian: Hamiltonian,
    point: Mapping[str, Fraction],
    t0: Fraction,
    times: Mapping[int, Fraction],
    digits: int,
) -> Iterator[FlowPointInDegrees]:
    """The exact flow from the point and t0, at these times after it by their N."""
    for step, time in times.items():
        yield _flow_point(hamiltonian, point, t0, step, time, digits)


def _flow_point(
    hamiltonian: Hamiltonian,
    point: Mapping[str, Fraction],
    t0: Fraction,
    step: int,
    time: Fraction,
    digits: int,
) -> FlowPointInDegrees:
    size = max(map(abs, point.values()))
    try:
        for guard in GUARDS:
            at = solution_in_degrees(hamiltonian, point, time, digits + guard, t0)
            last = guard == GUARDS[-1]
            values = {
                name: _rounded((x, at.bound), digits, last, size) for name, x in at.point.items()
            }
            if all(values.values()):
                return FlowPointInDegrees(
                    step=step,
                    time=text(time),
                    status="finished",
                    kind="enclosed" if at.enclosed else "estimated",
                    p=_list(values, "p"),
                    q=_list(values, "q"),
                )
    except InputError as error:
        if error.name != "digits":
            raise
    except NoFlowError:
        pass
    return FlowPointInDegrees(
        step=step, time=text(time), status="not followed", kind=None, p=None, q=None
    )
