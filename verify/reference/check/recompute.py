"""Values of reference data once more: in balls, from the textbook's formulas, by Taylor arithmetic.

Nothing here is shared with what made them: the formula of H is read by
`verify.reference.check.tape`, steps and Jacobians are those of `verify.reference.check.textbook`,
and det J is a d − b c of the four entries. The number system is flint's balls, so that what is
recomputed of a scheme's orbit is rigorous.
"""

from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from itertools import zip_longest
from typing import Any

import flint

from verify.arithmetic.exact import magnitude
from verify.reference.check.difference import Findings, Place
from verify.reference.check.exact_flow import BlowsUpError, State, states_at
from verify.reference.check.recompute_proof import proof_again, shown
from verify.reference.check.tape import NotReadError
from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import Field, Step, UnknownSchemeError, step_of
from verify.reference.make.models import VALUES, Data, Flow, Run, values_of
from verify.scenes.results.reference import FlowPoint, OrbitPoint, Rounded

FIRST_BITS, MORE_PER_DIGIT, DOUBLINGS = 320, 4, 5
_SHARP = 5  # digits beyond those printed to which an exact value must be met
_ESCAPED = 4000  # bits of |z| at which an orbit is said to have left
_FLOW_DIGITS = (8, 40, 100)  # beyond those printed, in turn


class TooWideError(Exception):
    """A ball too wide to tell."""


def recomputed(data: Data, file: str, kind: str, index: int) -> Findings:
    """One run, flow or proof of the data again."""
    found = Findings()
    try:
        given = {name: Fraction(value) for name, value in data.parameters.items()}
        known = Field(data.hamiltonian, given)
        if kind == "run":
            _run(known, data.runs[index], file, found)
        elif kind == "flow":
            _flow(known, data.flow[index], file, found)
        else:
            proof_again(known, data, data.proofs[index], Place(found, file))
    except (UnknownSchemeError, NotReadError) as error:
        Place(found, file, f"{kind} no. {index + 1}").is_left_out(error)
    return found


# -- a scheme's orbit -----------------------------------------------------------------------------


def _run(known: Field, run: Run, file: str, found: Findings) -> None:
    step = step_of(run.scheme, known)
    bits = FIRST_BITS + MORE_PER_DIGIT * run.digits
    for attempt in range(DOUBLINGS):
        again = Findings()
        with suppress(TooWideError), flint.ctx.workprec(bits << attempt):
            _orbit(step, run, Place(again, file), final=attempt == DOUBLINGS - 1)
            found.add(again)
            return
    last = Place(found, file, f"{run.label}, step {run.rows[-1].step}")
    last.is_left_out(f"{bits << (DOUBLINGS - 1)} bits do not tell")


def _orbit(step: Step, run: Run, file: Place, *, final: bool) -> None:
    """Every row of a run; TooWideError where a ball does not tell. `final`: the last try."""
    orbit = _Orbit(step, run.start, Fraction(run.step_size))
    size = max(abs(Fraction(run.p)), abs(Fraction(run.q)))
    left: int | None = None
    for row in run.rows:
        at = file.at(f"{run.label}, step {row.step}")
        if left is not None:  # and so it has at all later steps
            at.findings.recomputed += 1
            at.must(row.failed_step == left, "failed_step", str(left), str(row.failed_step))
            continue
        if row.status == "unresolved":
            at.is_left_out("has no values")
            continue
        if row.status == "left range":
            left = _leaves_range(orbit, row, at, final)
            if left is None:
                return
            continue
        orbit.to(row.step)
        values = orbit.values()
        at.findings.recomputed += 1
        for name, cell in values_of(row).items():
            if name == "mse" and row.step == 0:
                continue
            if name == "delta_j" and not all(x.is_finite() for x in orbit.ahead()[0]):
                if not final:
                    raise TooWideError
                if cell is not None:  # no step begins there
                    at.differs(name, "null", cell.value)
                continue
            scale = size if name in ("p", "q") else Fraction(1)
            compare_cell(name, cell, values[name], run.digits, scale, at)


class _Orbit:
    """A scheme's orbit in balls, with the sums and the product over its steps."""

    def __init__(self, step: Step, start: Mapping[str, Fraction], h: Fraction) -> None:
        self.step, self.h = step, flint.arb(number(h))
        self.p, self.q = (flint.arb(number(start[name])) for name in ("p", "q"))
        self._t0, self._size = start.get("t", Fraction(0)), h
        self.done, self.squares, self.lam = 0, flint.arb(0), flint.arb(0)
        self._next: tuple[Any, Number] | None = None  # the state after, and ΔJ here

    def ahead(self) -> tuple[Any, Number]:
        if self._next is None:
            t = flint.arb(number(self._t0 + self.done * self._size))
            z, (a, b, c, d) = self.step(self.p, self.q, self.h, t)
            self._next = z, a * d - b * c - 1
        return self._next

    def to(self, count: int) -> None:
        """Goes on to the state after so many steps; TooWideError where a ball is not finite."""
        while self.done < count:
            (self.p, self.q), change = self.ahead()
            self.squares += change * change
            self.lam += change + self.lam * change
            self.done, self._next = self.done + 1, None
            if not (self.p.is_finite() and self.q.is_finite()):
                raise TooWideError

    def values(self) -> dict[str, Number]:
        mean = self.squares / self.done if self.done else self.squares
        numbers = self.p, self.q, self.ahead()[1], mean, self.lam
        return dict(zip(VALUES, numbers, strict=True))


def _leaves_range(orbit: _Orbit, row: OrbitPoint, at: Place, final: bool) -> int | None:
    """The step after which the orbit is beyond 2^4000, or not defined; None where it is neither.

    A ball that is not finite may be too wide only: that is not taken for an answer before `final`.
    """
    limit = flint.arb(2) ** _ESCAPED
    while orbit.done < (row.failed_step or 0):
        try:
            orbit.to(orbit.done + 1)
        except TooWideError:
            if not final:
                raise
            break
        sizes = abs(orbit.p), abs(orbit.q)
        if any(x > limit for x in sizes):
            break
        if not all(x < limit for x in sizes):
            raise TooWideError
    else:
        at.differs("status", f"defined after {orbit.done} steps", row.status)
        return None
    at.findings.recomputed += 1
    given = row.failed_step
    at.must(orbit.done == given, "failed_step", str(orbit.done), str(given))
    return orbit.done


def compare_cell(
    name: str,
    cell: Rounded | None,
    ball: Number,
    digits: int,
    size: Fraction,
    at: Place,
    places: int = 0,
) -> None:
    """Whether the printed number is the one to which every number of the ball rounds.

    An exact number must be met to some digits more; 0 to twice the digits, or to `places`.
    """
    if cell is None:
        at.differs(name, shown(ball, digits), "null")
        return
    value, radius = flint.arb(cell.value), flint.arb(cell.radius)  # no rationals: 1e+999999999
    low, high = value - radius, value + radius
    if ball < low or ball > high:
        at.differs(name, shown(ball, digits), cell.value)
        return
    if radius == 0:
        ten, exact_zero = flint.arb(10), bool(value == 0)
        near = ten ** (magnitude(size) if size else 0) if exact_zero else abs(value)
        places = places or (2 * digits if exact_zero else digits + _SHARP)
        sharp = near / ten**places
        inside = ball.rad() <= sharp
    else:
        inside = ball >= low and ball <= high
    if not inside:
        raise TooWideError


# -- the exact flow -------------------------------------------------------------------------------


def _flow(known: Field, flow: Flow, file: str, found: Findings) -> None:
    rows = [row for row in flow.rows if row.status != "not followed"]
    for row in flow.rows:
        if row.status == "not followed":
            Place(found, file, f"{flow.label}, step {row.step}").is_left_out("has no values")
    times = [row.step * Fraction(flow.step_size) for row in rows]
    for more in _FLOW_DIGITS:
        again, digits = Findings(), flow.digits + more
        states, why = states_at(known, flow.start, times, digits)
        with suppress(TooWideError), flint.ctx.workprec(MORE_PER_DIGIT * digits + FIRST_BITS):
            for row, state in zip_longest(rows, states):
                at = Place(again, file, f"{flow.label}, step {row.step}")
                if state is None:
                    _not_reached(known, flow, row, why, at)
                else:
                    _reached(flow, row, state, at)
            found.add(again)
            return
    last = Place(found, file, f"{flow.label}, step {flow.rows[-1].step}")
    last.is_left_out("more digits do not tell")


def _reached(flow: Flow, row: FlowPoint, state: State, at: Place) -> None:
    """A row whose time was reached."""
    at.findings.recomputed += 1
    if row.status == "blows up":
        at.differs("status", "finished", row.status)
        return
    size, places = max(abs(Fraction(flow.p)), abs(Fraction(flow.q))), flow.digits + _SHARP
    for (name, cell), ball in zip(values_of(row).items(), state, strict=True):
        compare_cell(name, cell, ball, flow.digits, size, at, places)


def _not_reached(
    known: Field, flow: Flow, row: FlowPoint, why: Exception | None, at: Place
) -> None:
    """A row whose time was not reached: it may blow up; if it does not, H is still what it was."""
    if row.status == "blows up" and isinstance(why, BlowsUpError):
        at.findings.recomputed += 1
        return
    at.is_left_out(why)
    if row.p is not None and row.q is not None and not known.timed:
        start = (flint.arb(number(Fraction(x))) for x in (flow.p, flow.q))
        ends = (flint.arb(x.value) + flint.arb(0, 1) * flint.arb(x.radius) for x in (row.p, row.q))
        first, last = known.energy(*start), known.energy(*ends)
        if first < last or first > last:
            told = f"p and q where H is {shown(first, flow.digits)}"
            at.differs("p, q", told, shown(last, flow.digits))
