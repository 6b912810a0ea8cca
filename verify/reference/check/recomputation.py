"""Values of reference data computed again: in balls, from the textbook's formulas, by Taylor
arithmetic.

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
from verify.reference.check.ball_motions import BallOrbit, BlowsUpError, TooWideError, states_at
from verify.reference.check.difference import DataFindings, DataPlace
from verify.reference.check.proof_recomputation import format_ball, recompute_proof
from verify.reference.check.tape import NotReadError
from verify.reference.check.taylor import Number, number
from verify.reference.check.textbook import Step, TextbookField, UnknownSchemeError, Vector, step_of
from verify.reference.make.models import AnyData, AnyFlow, AnyRun
from verify.reference.make.row_values import AFTER_A_STEP, values_of
from verify.scenes.results.reference import FlowRow, OrbitRow, Rounded

_FIRST_BITS, _MORE_PER_DIGIT, _DOUBLINGS = 320, 4, 5
_SHARP = 5  # digits beyond those printed to which an exact value must be met
_ESCAPED = 4000  # bits of |z| at which an orbit is said to have left
_FLOW_DIGITS = (8, 40, 100)  # beyond those printed, in turn


def recompute_unit(data: AnyData, file: str, kind: str, index: int) -> DataFindings:
    """Recompute one run, flow or proof of the data, and return the differences."""
    findings = DataFindings()
    try:
        parameters = {name: Fraction(value) for name, value in data.parameters.items()}
        field = TextbookField(data.hamiltonian, parameters, data.degrees)
        if kind == "run":
            _check_run(field, data.runs[index], file, findings)
        elif kind == "flow":
            _check_flow(field, data.flow[index], file, findings)
        else:
            recompute_proof(field, data, data.proofs[index], DataPlace(findings, file))
    except (UnknownSchemeError, NotReadError) as error:
        DataPlace(findings, file, f"{kind} no. {index + 1}").is_left_out(error)
    return findings


def _size_of_start(item: AnyRun | AnyFlow) -> Fraction:
    """Return the greatest |coordinate| at the start."""
    return max(abs(x) for name, x in item.start.items() if name != "t")


# -- a scheme's orbit -----------------------------------------------------------------------------


def _check_run(field: TextbookField, run: AnyRun, file: str, findings: DataFindings) -> None:
    step = step_of(run.scheme, field)
    bits = _FIRST_BITS + _MORE_PER_DIGIT * run.digits
    # Balls widen along the orbit at a rate that is not known in advance: the working precision is
    # doubled until every row is decided. Findings of an undecided attempt are discarded.
    for attempt in range(_DOUBLINGS):
        attempt_findings = DataFindings()
        with suppress(TooWideError), flint.ctx.workprec(bits << attempt):
            _check_orbit(
                field, step, run, DataPlace(attempt_findings, file), final=attempt == _DOUBLINGS - 1
            )
            findings.add(attempt_findings)
            return
    last_row = DataPlace(findings, file, f"{run.label}, step {run.rows[-1].step}")
    last_row.is_left_out(f"{bits << (_DOUBLINGS - 1)} bits do not tell")


def _check_orbit(
    field: TextbookField, step: Step, run: AnyRun, file: DataPlace, *, final: bool
) -> None:
    """Compare every row of a run; TooWideError if a ball does not decide. `final`: the last
    attempt."""
    orbit = BallOrbit(field, step, run)
    size = _size_of_start(run)
    failed_step: int | None = None
    for row in run.rows:
        place = file.at_row(f"{run.label}, step {row.step}")
        if failed_step is not None:  # the orbit has left its range at all later steps
            place.findings.recomputed += 1
            place.require(
                row.failed_step == failed_step,
                "failed_step",
                str(failed_step),
                str(row.failed_step),
            )
            continue
        if row.status == "unresolved":
            place.is_left_out("has no values")
            continue
        if row.status == "left range":
            failed_step = _check_escape(orbit, row, place, final)
            if failed_step is None:
                return
            continue
        orbit.advance_to(row.step)
        values = orbit.values()
        place.findings.recomputed += 1
        for name, cell in values_of(row, field.degrees).items():
            if name in AFTER_A_STEP and row.step == 0:
                continue
            if name not in values:
                if not final:
                    raise TooWideError
                if cell is not None:
                    place.differs(name, "null", cell.value)
                continue
            scale = size if name in field.names else Fraction(1)
            _compare_cell(name, cell, values[name], run.digits, scale, place)


def _check_escape(orbit: BallOrbit, row: OrbitRow, place: DataPlace, final: bool) -> int | None:
    """Return the last step before which the orbit is undefined, or after which it exceeds 2^4000.

    None if it does neither up to the row's step. A ball that is not finite may merely be too wide:
    only the `final` attempt takes it for an answer.
    """
    limit = flint.arb(2) ** _ESCAPED
    while orbit.done < (row.failed_step or 0):
        try:
            orbit.advance_to(orbit.done + 1)
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
        place.differs("status", f"defined after {orbit.done} steps", row.status)
        return None
    place.findings.recomputed += 1
    claimed = row.failed_step
    place.require(orbit.done == claimed, "failed_step", str(orbit.done), str(claimed))
    return orbit.done


def _compare_cell(
    name: str,
    cell: Rounded | None,
    ball: Number,
    digits: int,
    size: Fraction,
    place: DataPlace,
    places: int = 0,
) -> None:
    """Check that every number of the ball is within the radius of the printed number.

    If the radius is 0 the ball must be narrow: to `places` digits if that is not 0, else to some
    more than `digits`, and for the number 0 to twice as many relative to `size`.
    """
    if cell is None:
        place.differs(name, format_ball(ball, digits), "null")
        return
    value, radius = flint.arb(cell.value), flint.arb(cell.radius)  # no rationals: 1e+999999999
    low, high = value - radius, value + radius
    if ball < low or ball > high:
        place.differs(name, format_ball(ball, digits), cell.value)
        return
    if radius == 0:
        ten, exact_zero = flint.arb(10), bool(value == 0)
        magnitude_of_value = ten ** (magnitude(size) if size else 0) if exact_zero else abs(value)
        places = places or (2 * digits if exact_zero else digits + _SHARP)
        greatest_radius = magnitude_of_value / ten**places
        inside = ball.rad() <= greatest_radius
    else:
        inside = ball >= low and ball <= high
    if not inside:
        raise TooWideError


# -- the exact flow -------------------------------------------------------------------------------


def _check_flow(field: TextbookField, flow: AnyFlow, file: str, findings: DataFindings) -> None:
    rows = [row for row in flow.rows if row.status != "not followed"]
    for row in flow.rows:
        if row.status == "not followed":
            DataPlace(findings, file, f"{flow.label}, step {row.step}").is_left_out("has no values")
    times = [row.step * Fraction(flow.step_size) for row in rows]
    for guard in _FLOW_DIGITS:
        attempt_findings, digits = DataFindings(), flow.digits + guard
        states, reason = states_at(field, flow.start, times, digits)
        with suppress(TooWideError), flint.ctx.workprec(_MORE_PER_DIGIT * digits + _FIRST_BITS):
            for row, state in zip_longest(rows, states):
                place = DataPlace(attempt_findings, file, f"{flow.label}, step {row.step}")
                if state is None:
                    _check_unreached_row(field, flow, row, reason, place)
                else:
                    _check_reached_row(field, flow, row, state, place)
            findings.add(attempt_findings)
            return
    last_row = DataPlace(findings, file, f"{flow.label}, step {flow.rows[-1].step}")
    last_row.is_left_out("more digits do not tell")


def _check_reached_row(
    field: TextbookField, flow: AnyFlow, row: FlowRow, state: Vector, place: DataPlace
) -> None:
    """Compare a row whose time was reached."""
    place.findings.recomputed += 1
    if row.status == "blows up":
        place.differs("status", "finished", row.status)
        return
    size, places = _size_of_start(flow), flow.digits + _SHARP
    cells = values_of(row, field.degrees)
    for (name, cell), ball in zip(cells.items(), state, strict=True):
        _compare_cell(name, cell, ball, flow.digits, size, place, places)


def _check_unreached_row(
    field: TextbookField, flow: AnyFlow, row: FlowRow, reason: Exception | None, place: DataPlace
) -> None:
    """Check a row whose time was not reached: the solution may blow up; if not, H must be
    conserved."""
    if row.status == "blows up" and isinstance(reason, BlowsUpError):
        place.findings.recomputed += 1
        return
    place.is_left_out(reason)
    cells = values_of(row, field.degrees)
    ends = [_ball_of(cell) for cell in cells.values() if cell is not None]
    if len(ends) == len(cells) and not field.time_dependent:
        start = [flint.arb(number(flow.start[name])) for name in field.names]
        first, last = (field.energy(z, flint.arb(0)) for z in (start, ends))
        if first < last or first > last:
            expected = f"{' and '.join(field.names)} where H is {format_ball(first, flow.digits)}"
            place.differs(", ".join(field.names), expected, format_ball(last, flow.digits))


def _ball_of(cell: Rounded) -> Number:
    return flint.arb(cell.value) + flint.arb(0, 1) * flint.arb(cell.radius)
