"""Whether a user's step is a scheme for H, and what it preserves: proved, else measured."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.black_box import Measured, Point, carried_step, measured
from verify.carried_number import UntraceableError
from verify.errors import InputError
from verify.exact import decimal, plain, text
from verify.hamiltonian import Hamiltonian
from verify.integrator_agreement import by_duals, by_graph, must_agree
from verify.integrator_claims import with_claims
from verify.integrator_faults import examined
from verify.integrator_results import NOTHING, Claims, Finding
from verify.own_functions import copied
from verify.own_step import Step, StepError, last_line, within
from verify.proof.order import prove
from verify.rounded_order import Rounded, rounded_orders
from verify.trace import Tape
from verify.traced_map import TracedMap, traced_map
from verify.verdict import Verdict

POINTS: tuple[Point, ...] = (
    (Fraction(1, 3), Fraction(3, 5)),
    (Fraction(-1, 2), Fraction(7, 8)),
    (Fraction(1, 7), Fraction(6, 5)),
    (Fraction(3, 4), Fraction(-2, 5)),
)
_PROOF_SECONDS = 30.0
_SEEN = 1e-6  # a ΔJ that no tolerance makes
_NO_AREA = 1e-8  # a ΔJ above it, of no power of h, or a probe's error, leaves it undecided


def check_integrator(
    step: Step, hamiltonian: Hamiltonian, claims: Claims = NOTHING, start: Point | None = None
) -> Finding:
    """Runs the user's code. `start`: an initial value to look at beside those of `POINTS`.

    Raises InputError where a parameter of H has no value.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")
    points = ((start,) if start else ()) + POINTS
    faults = examined(step, points)
    fatal = [fault for fault in faults if fault.fatal]
    if fatal:
        names = tuple(fault.name for fault in faults)
        return Finding(Verdict.REFUTED, fatal[0].text, "calls", faults=names)
    found = _found(step, hamiltonian, points)
    if found.verdict is Verdict.REFUTED:
        found = found.noting(*_exchanged(step, hamiltonian, points))
    found = replace(found, faults=tuple(fault.name for fault in faults))
    found = found.noting(*(fault.text for fault in faults))
    return with_claims(found, claims, step, hamiltonian, points)


def _found(step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]) -> Finding:
    notes: list[str] = []
    try:
        with within(_PROOF_SECONDS, "its proof takes too long"):
            return _proved(step, hamiltonian, points)
    except Exception as error:  # the user's code may raise anything
        notes.append(f"no proof: {_why(error)}")
    for how in ("duals", "floats"):
        try:
            if how == "duals":
                must_agree(step, points, by_duals(step), how)
            found = measured(step, hamiltonian, points, how)
            return _with_floats(_of_measured(found), found, step, hamiltonian, points).noting(
                *notes
            )
        except Exception as error:  # as above
            notes.append(f"not measured with {how}: {_why(error)}")
    return Finding(Verdict.UNDECIDED, "it can be neither traced nor measured", "calls").noting(
        *notes
    )


def _exchanged(step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]) -> list[str]:
    """Whether it is a scheme when p and q stand in each other's place."""
    exchange = {"p": "q", "q": "p", "h": "h"}
    a, b, c = (exchange[name] for name in step.order)
    other = replace(step, order=(a, b, c))
    if not _found(other, hamiltonian, points).verdict.holds:
        return []
    return [f"with arguments in the order {a},{b},{c} it is a scheme for this H"]


def _why(error: Exception) -> str:
    known = isinstance(error, UntraceableError | StepError | InputError)
    return str(error) if known else last_line(error)


# -- proved ---------------------------------------------------------------------------------------


def _proved(step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]) -> Finding:
    tape = Tape()
    symbols = [tape.symbol(name) for name in "pqh"]
    roots = carried_step(step, copied(step.function, tape), *symbols)
    if tape.refused:  # what is traced is then what it does where that fails
        raise UntraceableError(f"{tape.refused[0]}, and catches the error of a symbol that cannot")
    p_next, q_next = (x.node for x in roots)
    must_agree(step, points, lambda kind: by_graph(kind, p_next, q_next), "proof")
    traced = traced_map(hamiltonian, p_next, q_next)
    proof = prove(traced.step_map)
    found = Finding(
        proof.verdict,
        proof.reason,
        "proof",
        order=proof.order,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        order_known=proof.convergence_decided,
        leading=proof.first.text,
        delta_j=proof.step_map.delta_j_text,
        proof=proof,
    ).noting(f"traced with symbols; the map {traced.how}", *_readings(tape))
    found = _but_for_rounding(found, traced, tape)
    return _measured_area(found, step, hamiltonian, points)


def _readings(tape: Tape) -> list[str]:
    notes = ["h > 0 is taken for granted"] if tape.positive else []
    if tape.readings:
        shown = ", ".join(f"{x!r} as {text(v)}" for x, v in sorted(tape.readings.items()))
        notes.append(f"floats are read as the exact numbers that they are written for: {shown}")
    if tape.rounded:
        shown = ", ".join(map(repr, sorted(tape.rounded)))
        notes.append(f"floats taken by their exact binary values: {shown}")
    return notes


def _but_for_rounding(found: Finding, traced: TracedMap, tape: Tape) -> Finding:
    """The orders that hold but for the rounding of its coefficients, where they are others."""
    if not tape.rounded or traced.series is None:
        return found
    field, p, q = traced.series
    better = rounded_orders(field, p, q)
    if better.convergence == found.convergence_order and better.area in (found.order, None):
        return found
    if better.residue == 0:
        return found
    kept = found.area_preserving is True
    area = None if kept else better.area
    leading = found.leading
    if not kept:
        leading = field.ring.text(better.leading) if better.leading is not None else None
    return replace(
        found,
        verdict=Verdict.MEASURED if _is_scheme(better) else found.verdict,
        reason=_rounded_reason(found, better, p.most),
        order=area,
        area_preserving=True if kept else None if area is None else False,
        convergence_order=better.convergence if better.convergence is not None else p.most,
        leading=leading,
        proof=None,
    )


def _is_scheme(better: Rounded) -> bool:
    return better.convergence is None or better.convergence >= 1


def _rounded_reason(found: Finding, better: Rounded, most: int) -> str:
    order = f"order {better.convergence}" if better.convergence is not None else f"order ≥ {most}"
    if found.area_preserving:
        area = "det J ≡ 1, proved"
    else:
        area = f"ΔJ = O(h^{better.area if better.area is not None else most})"
    strictly = found.convergence_order
    exactly = f"; taken exactly, they make the order {strictly}" if strictly is not None else ""
    residue = decimal(better.residue, 2)
    return (
        f"{order} and {area}, but for the rounding of its coefficients, which leaves residues of "
        f"up to {residue}{exactly}"
    )


def _measured_area(
    found: Finding, step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]
) -> Finding:
    """What algebra leaves open of ΔJ is measured with dual numbers."""
    if found.area_preserving is not None or found.verdict is Verdict.REFUTED:
        return found
    try:
        other = _of_measured(measured(step, hamiltonian, points, "duals"))
    except Exception as error:  # the user's code may raise anything
        return found.noting(f"not measured: {_why(error)}")
    if other.verdict is not Verdict.MEASURED:
        return found
    return replace(
        other,
        convergence_order=found.convergence_order,
        order_known=found.order_known,
        reason=f"{other.reason} (the coefficients of ΔJ are not decided: {found.reason})",
        notes=found.notes,
        leading=found.leading,
    )


# -- measured -------------------------------------------------------------------------------------


def _of_measured(found: Measured) -> Finding:
    area, distance = found.area, found.distance
    exact = all(row.error <= 10 * row.error_noise for row in found.rows)
    order = None if distance.power is None else distance.power - 1
    vanishes, said = _area_said(found)
    tail = distance.tail
    if exact:
        told = "the map is the exact flow to its last digits"
    else:
        known = order is not None
        seen = f"{Fraction(distance.first)} … {distance.last:.1e}"
        told = f"the map's order is {order}, as seen for h = {seen}"
        told = told if known else "its error follows no power of h"
    verdict = Verdict.MEASURED
    if order is not None and order < 1:
        verdict, told = Verdict.REFUTED, f"not a scheme for this H: {told}"
    elif (area.power is None and not vanishes) or (order is None and not exact):
        verdict = Verdict.UNDECIDED
    sure = tail is None or tail.small
    finding = Finding(
        verdict,
        f"{told}; {said}",
        found.how,
        order=area.power,
        area_preserving=True if vanishes else False if area.power is not None else None,
        convergence_order=order,
        order_known=exact or (order is not None and sure),
        largest=abs(found.largest.delta_j),
        probe_error=found.noise,
    )
    if tail is None:
        return finding
    return finding.noting(
        f"for h below {tail.h:.1e}, where its error is {tail.error:.1e}, that shrinks as "
        f"h^{tail.power} only, as the tolerance of a loop or a small mistake makes it"
    )


def _with_floats(
    found: Finding,
    by_duals: Measured,
    step: Step,
    hamiltonian: Hamiltonian,
    points: Sequence[Point],
) -> Finding:
    """A small ΔJ of a step that compares values is taken from floats.

    A loop with a tolerance ends before the derivatives have settled: what dual numbers have is then
    the derivative of the operations that were done, and no more of the map.
    """
    if by_duals.how != "duals" or not by_duals.opaque or found.order is None:
        return found
    if found.largest is None or found.largest > _SEEN:
        return found
    other = _of_measured(measured(step, hamiltonian, points, "floats"))
    area = replace(
        found,
        verdict=other.verdict if found.verdict is Verdict.MEASURED else found.verdict,
        reason=f"{found.reason.partition('; ')[0]}; {other.reason.partition('; ')[2]}",
        order=other.order,
        area_preserving=other.area_preserving,
        largest=other.largest,
        probe_error=other.probe_error,
    )
    return area.noting("ΔJ is measured with floats, as a tolerance may hide in a smaller one")


def _area_said(found: Measured) -> tuple[bool, str]:
    """Whether ΔJ is 0 as far as can be seen, and what is seen of it."""
    if found.area.power is not None:
        return False, f"ΔJ shrinks as h^{found.area.power}"
    largest, noise = abs(found.largest.delta_j), found.noise
    most = max(largest, noise)  # a ΔJ of 0 is not known better than its noise
    shown = plain(Fraction(most), 2) if most >= 1e-3 else f"{most:.1e}"
    if noise > _NO_AREA:
        return False, f"ΔJ is hidden by the probe's own error, {noise:.1e}"
    if largest <= (_NO_AREA if found.how == "duals" else 10 * noise):
        return True, f"|ΔJ| ≤ {shown} at every point and step"
    return False, f"|ΔJ| up to {shown} follows no power of h"
