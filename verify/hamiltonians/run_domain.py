"""The start of a run, and the times of its steps: H must be defined and smooth at all of them.

A step may pass over a pole in t without a trace. So the conditions on t alone are enclosed over the
time of the run. If the enclosure does not decide, the time is halved, down to a 64th of a step.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import flint

from verify.algebra.domain import holds
from verify.algebra.embedding import embed
from verify.algebra.enclosure import enclose_over
from verify.algebra.expressions.function_nodes import Relation
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import Number, NumberOrList, rational, text
from verify.arithmetic.flint_precision import working_precision
from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.hamiltonians.hamiltonian import Hamiltonian

_BITS = 96
_MAX_ENCLOSURES = 20_000  # after so many the search ends, and the conditions count as true
_PARTS_PER_STEP = 64


def point_of(hamiltonian: Hamiltonian, q: NumberOrList, p: NumberOrList) -> dict[str, Fraction]:
    """Return the exact values of the coordinates, by name.

    `q`, `p`: a number in the plane, else a list. Raises InputError for too few or too many numbers.

    >>> point_of(Hamiltonian.parse("p1**2/2 + p2**2/2 + q1*q2"), ["0.5", 0], p=[1, 2])["q1"]
    Fraction(1, 2)
    """
    degrees, point = hamiltonian.degrees, {}
    for letter, numbers in (("p", p), ("q", q)):
        values: Sequence[Number]
        if isinstance(numbers, Sequence) and not isinstance(numbers, str):
            values = numbers
            if hamiltonian.planar:
                raise InputError(letter, values, "is a list; H is of p and q: give one number")
        else:
            values = [numbers]
        names = [name for name in hamiltonian.coordinates if name[0] == letter]
        if len(values) != degrees:
            values_text = ", ".join(text(x) if isinstance(x, Fraction) else str(x) for x in values)
            problem = f"has {len(values)} of {degrees} numbers; H is of {', '.join(names)}"
            raise InputError(letter, values_text, problem)
        for name, value in zip(names, values, strict=True):
            point[name] = rational(value, name)
    return {name: point[name] for name in hamiltonian.coordinates}


def start_of(
    system: Hamiltonian,
    q: NumberOrList | None,
    p: NumberOrList | None,
    start: Mapping[str, Number] | None,
) -> dict[str, Fraction]:
    """Return the exact values of the coordinates by name: of an H from `q` and `p`, of equations
    from `start`. Raises InputError for what is missing or does not belong.
    """
    if system.has_energy:
        if start:
            raise InputError("start", list(start), "is of equations; an H has q and p")
        for name, value in (("q", q), ("p", p)):
            if value is None:
                raise InputError(name, None, "not a number; give the initial value")
        assert q is not None and p is not None  # noqa: S101, PT018 - for mypy
        return point_of(system, q, p)
    names = system.coordinates
    for name, value in (("q", q), ("p", p)):
        if value is not None:
            problem = f"is of an H; equations have a start, as {names[0]}=1"
            raise InputError(name, value, problem)
    if not isinstance(start, Mapping):
        problem = f"is no values by name; equations have one of each of {', '.join(names)}"
        raise InputError("start", start or NOT_GIVEN, problem)
    for name in start:
        if name not in names:
            raise unknown_name("start", name, names)
    for name in names:
        if name not in start:
            raise InputError("start", ", ".join(start), f"has no value of {name}")
    return {name: rational(start[name], name) for name in names}


def coordinate_texts(
    hamiltonian: Hamiltonian, point: Mapping[str, Fraction], letter: str
) -> str | tuple[str, ...]:
    """Return q or p (`letter`) of a point as text; in n degrees of freedom as texts."""
    p, q = hamiltonian.halves(tuple(text(point[name]) for name in hamiltonian.coordinates))
    texts: str | tuple[str, ...] = {"p": p, "q": q}[letter]
    return texts


def start_texts(
    hamiltonian: Hamiltonian, point: Mapping[str, Fraction], t0: Fraction | None
) -> dict[str, Any]:
    """Return the start of a run in the form of results: q, p and t0, which is None if H has no
    time."""
    return {
        "q": coordinate_texts(hamiltonian, point, "q"),
        "p": coordinate_texts(hamiltonian, point, "p"),
        "t0": None if t0 is None else text(t0),
    }


def check_start(hamiltonian: Hamiltonian, q: NumberOrList, p: NumberOrList, t0: Number = 0) -> None:
    """Raise InputError if H is not defined, or not smooth, at (q, p), and at t0 if it depends on
    time.

    >>> check_start(Hamiltonian.parse("p**2/2 + log(q)"), -1, 0)
    Traceback (most recent call last):
    verify.errors.InputError: q, p=-1, 0: H is not smooth there; it is where q > 0
    """
    check_point(hamiltonian, point_of(hamiltonian, q, p), t0)


def check_point(hamiltonian: Hamiltonian, values: Mapping[str, Fraction], t0: Number) -> None:
    """Raise InputError if the system is not smooth at a point and t0, as `check_start` does."""
    # q comes first in messages, as in the arguments.
    names = sorted(values, key=lambda name: hamiltonian.has_energy and name[0] != "q")
    point = {name: values[name] for name in names}
    if hamiltonian.time_dependent:
        point["t"] = rational(t0, "t0")
    domain = hamiltonian.domain
    if domain.names <= set(point) and domain.contains(point) is False:
        values_text = ", ".join(map(text, point.values()))
        system = "H is" if hamiltonian.has_energy else "the field is"
        problem = f"{system} not smooth there; it is where {', '.join(domain.texts)}"
        raise InputError(", ".join(point), values_text, problem)


# -- the times of the steps -----------------------------------------------------------------------


def check_times(hamiltonian: Hamiltonian, t0: Fraction, step_size: Fraction, steps: int) -> None:
    """Raise InputError, which names the step, if H may not be smooth at some time of the run.

    >>> opened = Hamiltonian.parse("p**2/2 + q**2/(1 - t)")
    >>> check_times(opened, Fraction(0), Fraction(2), 9)
    Traceback (most recent call last):
    verify.errors.InputError: t0=0: at step 1, t = 0 … 2, H is not smooth; it is where t - 1 ≠ 0
    """
    fault = find_first_fault(hamiltonian, t0, step_size, steps)
    if fault is not None:
        begin = t0 + fault.step * step_size
        between = f"t = {text(begin)} … {text(begin + step_size)}"
        problem = f"at step {fault.step + 1}, {between}, H is not smooth; it is where"
        raise InputError("t0", text(t0), f"{problem} {fault.condition}")


class TimeFault(NamedTuple):
    """A step, counted from 0, during which H may not be smooth, and the condition that may fail."""

    step: int
    condition: str


def find_first_fault(
    hamiltonian: Hamiltonian, t0: Fraction, step_size: Fraction, steps: int
) -> TimeFault | None:
    """Return the first step in whose time H may not be smooth; None if there is none.

    Conditions are tried one by one: the step is the first for the first condition that may fail.
    `step_size` may be negative.
    """
    if not hamiltonian.time_dependent:
        return None
    domain = hamiltonian.domain
    for requirement, condition in zip(domain.requirements, domain.requirement_signs, strict=True):
        if {s.name for s in requirement.expression.free_symbols} == {"t"}:
            ring, (x,) = embed([requirement.expression], ("t",))
            search = _Search(ring, x, requirement.relation, t0, step_size)
            step = search.first(0, steps * _PARTS_PER_STEP)
            if step is not None:
                return TimeFault(step, condition)
    return None


class _Search:
    """The search for the first step in whose time the condition may fail."""

    def __init__(
        self, ring: Ring, x: Poly, relation: Relation, t0: Fraction, step_size: Fraction
    ) -> None:
        self.ring, self.x, self.relation = ring, x, relation
        self.t0, self.part = t0, step_size / _PARTS_PER_STEP
        self.budget = _MAX_ENCLOSURES

    def first(self, low: int, high: int) -> int | None:
        """Return the first step among the parts of steps from `low` to `high`; None if the
        condition holds in all, or the budget is spent."""
        if self.budget <= 0 or self._holds(low, high):
            return None
        if high - low == 1:
            return low // _PARTS_PER_STEP
        middle = (low + high) // 2
        first_half = self.first(low, middle)
        return self.first(middle, high) if first_half is None else first_half

    def _holds(self, low: int, high: int) -> bool:
        """Return True if the condition holds over the whole interval."""
        self.budget -= 1
        with working_precision(_BITS):
            ends = (rational_ball(self.t0 + n * self.part) for n in (low, high))
            # The condition is enclosed over the whole interval at once, so that no pole is missed.
            interval = next(ends).union(next(ends))
            enclosure: flint.arb | None = enclose_over(self.ring, self.x, {"t": interval})
            return holds(enclosure, self.relation) is True
