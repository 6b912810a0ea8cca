"""Values of reference data once more: in balls, from the textbook's formulas, by Taylor arithmetic.

Nothing here is shared with what made them: the formula of H is read by `reference.tape`, steps and
Jacobians are those of `reference.textbook`, and det J is a d − b c of the four entries. The number
system is flint's balls, so that what is recomputed of a scheme's orbit is rigorous.
"""

from fractions import Fraction
from typing import Any

import flint

from reference.consistency import flow_label, run_label
from reference.difference import Difference, Found
from reference.exact_flow import BlowsUpError, NotFollowedError, states_at
from reference.models import Data, Flow, Run
from reference.recompute_proof import proof_again, shown
from reference.tape import NotReadError
from reference.taylor import Number, number
from reference.textbook import Field, Step, UnknownSchemeError, step_of
from verify.exact import magnitude
from verify.reference_results import OrbitPoint, Rounded

_FIRST_BITS, _MORE_PER_DIGIT, _DOUBLINGS = 320, 4, 5
_SHARP = 5  # digits beyond those printed to which an exact value must be met
_ESCAPED = 4000  # bits of |z| at which an orbit is said to have left
_FLOW_DIGITS = (8, 40, 100)  # beyond those printed, in turn
_VALUES = ("p", "q", "delta_j", "mse", "lam")


class _TooWide(Exception):  # noqa: N818 - no error: the same is done with more bits
    """A ball too wide to tell."""


def recomputed(data: Data, file: str, kind: str, index: int) -> Found:
    """One run, flow or proof of the data again."""
    found = Found()
    try:
        given = {name: Fraction(value) for name, value in data.parameters.items()}
        known = Field(data.hamiltonian, given)
        if kind == "run":
            _run(known, data.runs[index], file, found)
        elif kind == "flow":
            _flow(known, data.flow[index], file, found)
        else:
            proof_again(known, data, data.proofs[index], file, found)
    except (UnknownSchemeError, NotReadError) as error:
        found.not_recomputed.append(f"{file}: {kind} no. {index + 1}: {error}")
    return found


# -- a scheme's orbit -----------------------------------------------------------------------------


def _run(known: Field, run: Run, file: str, found: Found) -> None:
    step = step_of(run.scheme, known)
    bits = _FIRST_BITS + _MORE_PER_DIGIT * run.digits
    for attempt in range(_DOUBLINGS):
        again = Found()
        try:
            with flint.ctx.workprec(bits):
                _orbit(step, run, file, again, final=attempt == _DOUBLINGS - 1)
        except _TooWide:
            bits *= 2
            continue
        found.add(again)
        return
    label = run_label(run, run.rows[-1].step)
    found.not_recomputed.append(f"{file}: {label}: {bits // 2} bits do not tell")


def _orbit(step: Step, run: Run, file: str, found: Found, *, final: bool) -> None:
    """Every row of a run; _TooWide where a ball does not tell. `final`: there is no further try."""
    orbit = _Orbit(step, Fraction(run.p), Fraction(run.q), Fraction(run.step_size))
    size = max(abs(Fraction(run.p)), abs(Fraction(run.q)))
    left: int | None = None
    for row in run.rows:
        label = run_label(run, row.step)
        if left is not None:  # and so it has at all later steps
            found.rows += 1
            if row.failed_step != left:
                given = str(row.failed_step)
                found.differences.append(Difference(file, label, "failed_step", str(left), given))
            continue
        if row.status == "unresolved":
            found.not_recomputed.append(f"{file}: {label}: has no values")
            continue
        if row.status == "left range":
            left = _left(orbit, row, file, label, found, final)
            if left is None:
                return
            continue
        orbit.to(row.step)
        values = orbit.values()
        found.rows += 1
        for name in _VALUES:
            cell, shown = getattr(row, name), "lambda" if name == "lam" else name
            if name == "mse" and row.step == 0:
                continue
            if name == "delta_j" and not all(x.is_finite() for x in orbit.ahead()[0]):
                if not final:
                    raise _TooWide
                if cell is not None:  # no step begins there
                    found.differences.append(Difference(file, label, shown, "null", cell.value))
                continue
            scale = size if name in ("p", "q") else Fraction(1)
            _compare(cell, values[name], run.digits, scale, (file, label, shown), found)


class _Orbit:
    """A scheme's orbit in balls, with the sums and the product over its steps."""

    def __init__(self, step: Step, p: Fraction, q: Fraction, h: Fraction) -> None:
        self.step, self.h = step, flint.arb(number(h))
        self.p, self.q = flint.arb(number(p)), flint.arb(number(q))
        self.done, self.squares, self.lam = 0, flint.arb(0), flint.arb(0)
        self._next: tuple[Any, Number] | None = None  # the state after, and ΔJ here

    def ahead(self) -> tuple[Any, Number]:
        if self._next is None:
            z, (a, b, c, d) = self.step(self.p, self.q, self.h)
            self._next = z, a * d - b * c - 1
        return self._next

    def to(self, count: int) -> None:
        """Goes on to the state after so many steps; _TooWide where a ball is not finite."""
        while self.done < count:
            (self.p, self.q), change = self.ahead()
            self.squares += change * change
            self.lam += change + self.lam * change
            self.done, self._next = self.done + 1, None
            if not (self.p.is_finite() and self.q.is_finite()):
                raise _TooWide

    def values(self) -> dict[str, Number]:
        mean = self.squares / self.done if self.done else self.squares
        return {"p": self.p, "q": self.q, "delta_j": self.ahead()[1], "mse": mean, "lam": self.lam}


def _left(
    orbit: _Orbit, row: OrbitPoint, file: str, label: str, found: Found, final: bool
) -> int | None:
    """The step after which the orbit is beyond 2^4000, or not defined; None where it is neither.

    A ball that is not finite may be too wide only: that is not taken for an answer before `final`.
    """
    limit = flint.arb(2) ** _ESCAPED
    while orbit.done < (row.failed_step or 0):
        try:
            orbit.to(orbit.done + 1)
        except _TooWide:
            if not final:
                raise
            break
        sizes = abs(orbit.p), abs(orbit.q)
        if any(x > limit for x in sizes):
            break
        if not all(x < limit for x in sizes):
            raise _TooWide
    else:
        at = f"{orbit.done} steps"
        found.differences.append(
            Difference(file, label, "status", f"defined after {at}", row.status)
        )
        return None
    found.rows += 1
    if orbit.done != row.failed_step:
        wanted, given = str(orbit.done), str(row.failed_step)
        found.differences.append(Difference(file, label, "failed_step", wanted, given))
    return orbit.done


def _compare(
    cell: Rounded | None,
    ball: Number,
    digits: int,
    size: Fraction,
    where: tuple[str, str, str],
    found: Found,
    places: int = 0,
) -> None:
    """Whether the printed number is the one to which every number of the ball rounds.

    An exact number must be met to some digits more; 0 to twice the digits, or to `places`.
    """
    if cell is None:
        found.differences.append(Difference(*where, shown(ball, digits), "null"))
        return
    value, radius = Fraction(cell.value), Fraction(cell.radius)
    low, high = (flint.arb(number(value + sign * radius)) for sign in (-1, 1))
    if ball < low or ball > high:
        found.differences.append(Difference(*where, shown(ball, digits), cell.value))
        return
    if radius == 0:
        near = abs(value) if value else Fraction(10) ** (magnitude(size) if size else 0)
        places = places or (digits + _SHARP if value else 2 * digits)
        sharp = flint.arb(number(near / Fraction(10) ** places))
        inside = ball.rad() <= sharp
    else:
        inside = ball >= low and ball <= high
    if not inside:
        raise _TooWide


# -- the exact flow -------------------------------------------------------------------------------


def _flow(known: Field, flow: Flow, file: str, found: Found) -> None:
    rows = []
    for row in flow.rows:
        if row.status == "not followed":
            label = flow_label(flow, row.step)
            found.not_recomputed.append(f"{file}: {label}: has no values")
        else:
            rows.append(row)
    times = [row.step * Fraction(flow.step_size) for row in rows if row.status == "finished"]
    p, q = Fraction(flow.p), Fraction(flow.q)
    size = max(abs(p), abs(q))
    for more in _FLOW_DIGITS:
        again = Found()
        try:
            states = states_at(known, p, q, times, flow.digits + more)
            with flint.ctx.workprec(_MORE_PER_DIGIT * (flow.digits + more) + _FIRST_BITS):
                _flow_rows(flow, states, file, size, again)
            for row in rows[len(times) :]:
                _burst(known, flow, row.step, file, again)
        except _TooWide:
            continue
        except NotFollowedError as error:
            again.not_recomputed.append(f"{file}: {flow_label(flow, rows[-1].step)}: {error}")
        found.add(again)
        return
    label = flow_label(flow, flow.rows[-1].step)
    found.not_recomputed.append(f"{file}: {label}: more digits do not tell")


def _flow_rows(flow: Flow, states: list[Any], file: str, size: Fraction, found: Found) -> None:
    finished = (row for row in flow.rows if row.status == "finished")
    for row, state in zip(finished, states, strict=True):
        found.rows += 1
        for name, ball in zip(("p", "q"), state, strict=True):
            where, places = (file, flow_label(flow, row.step), name), flow.digits + _SHARP
            _compare(getattr(row, name), ball, flow.digits, size, where, found, places)


def _burst(known: Field, flow: Flow, step: int, file: str, found: Found) -> None:
    """That the solution does grow beyond every bound before that step's time."""
    try:
        time = step * Fraction(flow.step_size)
        states_at(known, Fraction(flow.p), Fraction(flow.q), [time], flow.digits)
    except BlowsUpError:
        found.rows += 1
    else:
        where = file, flow_label(flow, step), "status"
        found.differences.append(Difference(*where, "finished", "blows up"))
