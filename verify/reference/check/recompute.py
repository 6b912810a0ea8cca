"""Values of reference data once more: in balls, from the textbook's formulas, by Taylor arithmetic.

Nothing here is shared with what made them: the formula of H is read by
`verify.reference.check.tape`, steps and Jacobians are those of `verify.reference.check.textbook`. W
is taken from the product of the Jacobians, M, as MᵀΩM − Ω, and det J from the whole matrix: in
several degrees of freedom the data were made with sums along the orbit and with Pfaffians. The
number system is flint's balls, so that what is recomputed of a scheme's orbit is rigorous.
"""

from contextlib import suppress
from fractions import Fraction
from itertools import zip_longest

import flint

from verify.arithmetic.exact import magnitude
from verify.reference.check.ball_orbit import Orbit, TooWideError
from verify.reference.check.difference import Findings, Place
from verify.reference.check.exact_flow import BlowsUpError, states_at
from verify.reference.check.recompute_proof import proof_again, shown
from verify.reference.check.tape import NotReadError
from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import Field, Step, UnknownSchemeError, Vector, step_of
from verify.reference.make.columns import AFTER_A_STEP, values_of
from verify.reference.make.models import AnyData, AnyFlow, AnyRun
from verify.scenes.results.reference import FlowRow, OrbitRow, Rounded

_FIRST_BITS, _MORE_PER_DIGIT, _DOUBLINGS = 320, 4, 5
_SHARP = 5  # digits beyond those printed to which an exact value must be met
_ESCAPED = 4000  # bits of |z| at which an orbit is said to have left
_FLOW_DIGITS = (8, 40, 100)  # beyond those printed, in turn


def recomputed(data: AnyData, file: str, kind: str, index: int) -> Findings:
    """One run, flow or proof of the data again."""
    found = Findings()
    try:
        given = {name: Fraction(value) for name, value in data.parameters.items()}
        known = Field(data.hamiltonian, given, data.degrees)
        if kind == "run":
            _run(known, data.runs[index], file, found)
        elif kind == "flow":
            _flow(known, data.flow[index], file, found)
        else:
            proof_again(known, data, data.proofs[index], Place(found, file))
    except (UnknownSchemeError, NotReadError) as error:
        Place(found, file, f"{kind} no. {index + 1}").is_left_out(error)
    return found


def _size(of: AnyRun | AnyFlow) -> Fraction:
    """The greatest |coordinate| at the start."""
    return max(abs(x) for name, x in of.start.items() if name != "t")


# -- a scheme's orbit -----------------------------------------------------------------------------


def _run(known: Field, run: AnyRun, file: str, found: Findings) -> None:
    step = step_of(run.scheme, known)
    bits = _FIRST_BITS + _MORE_PER_DIGIT * run.digits
    for attempt in range(_DOUBLINGS):
        again = Findings()
        with suppress(TooWideError), flint.ctx.workprec(bits << attempt):
            _orbit(known, step, run, Place(again, file), final=attempt == _DOUBLINGS - 1)
            found.add(again)
            return
    last = Place(found, file, f"{run.label}, step {run.rows[-1].step}")
    last.is_left_out(f"{bits << (_DOUBLINGS - 1)} bits do not tell")


def _orbit(known: Field, step: Step, run: AnyRun, file: Place, *, final: bool) -> None:
    """Every row of a run; TooWideError where a ball does not tell. `final`: the last try."""
    orbit = Orbit(known, step, run)
    size = _size(run)
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
        for name, cell in values_of(row, known.degrees).items():
            if name in AFTER_A_STEP and row.step == 0:
                continue
            if name not in values:
                if not final:
                    raise TooWideError
                if cell is not None:
                    at.differs(name, "null", cell.value)
                continue
            scale = size if name in known.names else Fraction(1)
            _compare_cell(name, cell, values[name], run.digits, scale, at)


def _leaves_range(orbit: Orbit, row: OrbitRow, at: Place, final: bool) -> int | None:
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
        sizes = [abs(x) for x in orbit.z]
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


def _compare_cell(
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


def _flow(known: Field, flow: AnyFlow, file: str, found: Findings) -> None:
    rows = [row for row in flow.rows if row.status != "not followed"]
    for row in flow.rows:
        if row.status == "not followed":
            Place(found, file, f"{flow.label}, step {row.step}").is_left_out("has no values")
    times = [row.step * Fraction(flow.step_size) for row in rows]
    for more in _FLOW_DIGITS:
        again, digits = Findings(), flow.digits + more
        states, why = states_at(known, flow.start, times, digits)
        with suppress(TooWideError), flint.ctx.workprec(_MORE_PER_DIGIT * digits + _FIRST_BITS):
            for row, state in zip_longest(rows, states):
                at = Place(again, file, f"{flow.label}, step {row.step}")
                if state is None:
                    _not_reached(known, flow, row, why, at)
                else:
                    _reached(known, flow, row, state, at)
            found.add(again)
            return
    last = Place(found, file, f"{flow.label}, step {flow.rows[-1].step}")
    last.is_left_out("more digits do not tell")


def _reached(known: Field, flow: AnyFlow, row: FlowRow, state: Vector, at: Place) -> None:
    """A row whose time was reached."""
    at.findings.recomputed += 1
    if row.status == "blows up":
        at.differs("status", "finished", row.status)
        return
    size, places = _size(flow), flow.digits + _SHARP
    cells = values_of(row, known.degrees)
    for (name, cell), ball in zip(cells.items(), state, strict=True):
        _compare_cell(name, cell, ball, flow.digits, size, at, places)


def _not_reached(
    known: Field, flow: AnyFlow, row: FlowRow, why: Exception | None, at: Place
) -> None:
    """A row whose time was not reached: it may blow up; if it does not, H is still what it was."""
    if row.status == "blows up" and isinstance(why, BlowsUpError):
        at.findings.recomputed += 1
        return
    at.is_left_out(why)
    cells = values_of(row, known.degrees)
    ends = [_ball(cell) for cell in cells.values() if cell is not None]
    if len(ends) == len(cells) and not known.timed:
        start = [flint.arb(number(flow.start[name])) for name in known.names]
        first, last = (known.energy(z, flint.arb(0)) for z in (start, ends))
        if first < last or first > last:
            told = f"{' and '.join(known.names)} where H is {shown(first, flow.digits)}"
            at.differs(", ".join(known.names), told, shown(last, flow.digits))


def _ball(cell: Rounded) -> Number:
    return flint.arb(cell.value) + flint.arb(0, 1) * flint.arb(cell.radius)
