"""Whether a user's step is a scheme for H, and what it preserves: proved, else measured."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from verify.black_box import FINER, Measured, Point, Row, carried_step, measured
from verify.carried_number import UntraceableError
from verify.dual import Dual, Duals
from verify.errors import InputError
from verify.exact import decimal, plain, text
from verify.hamiltonian import Hamiltonian
from verify.integrator import Step, StepError, examined, last_line, within
from verify.integrator_results import NOTHING, Claims, Counterexample, Finding, broken
from verify.own_functions import copied
from verify.proof.order import prove
from verify.rounded_order import Rounded, rounded_orders
from verify.trace import Node, Tape, in_order
from verify.traced_map import TracedMap, traced_map
from verify.verdict import Verdict

POINTS: tuple[Point, ...] = (
    (Fraction(1, 3), Fraction(3, 5)),
    (Fraction(-1, 2), Fraction(7, 8)),
    (Fraction(1, 7), Fraction(6, 5)),
    (Fraction(3, 4), Fraction(-2, 5)),
)
_SIZES = Fraction(1, 8), Fraction(1, 64)
_AGREES = {"proof": 1e-10, "duals": 1e-6}  # a loop's tolerance may end it elsewhere with duals
_PROOF_SECONDS = 30.0
_TOO_SLOW = 1.3  # times what a power allows: a step's other terms make less of it
_PLAINLY = 0.95
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
    found = replace(found, faults=tuple(fault.name for fault in faults))
    found = found.noting(*(fault.text for fault in faults))
    return _with_claims(found, claims, step, hamiltonian, points)


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
                _must_agree(step, points, _by_duals(step), how)
            return _of_measured(measured(step, hamiltonian, points, how)).noting(*notes)
        except Exception as error:  # as above
            notes.append(f"not measured with {how}: {_why(error)}")
    return Finding(Verdict.UNDECIDED, "it can be neither traced nor measured", "calls").noting(
        *notes
    )


def _why(error: Exception) -> str:
    known = isinstance(error, UntraceableError | StepError | InputError)
    return str(error) if known else last_line(error)


# -- proved ---------------------------------------------------------------------------------------


def _proved(step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]) -> Finding:
    tape = Tape()
    symbols = [tape.symbol(name) for name in "pqh"]
    roots = carried_step(step, copied(step.function, tape), *symbols)
    p_next, q_next = (x.node for x in roots)
    _must_agree(step, points, lambda kind: _by_graph(kind, p_next, q_next), "proof")
    traced = traced_map(hamiltonian, p_next, q_next)
    proof = prove(traced.step_map)
    found = Finding(
        proof.verdict,
        proof.reason,
        "proof",
        order=proof.order,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        order_known=not (proof.verdict is Verdict.UNDECIDED and "whether further" in proof.reason),
        leading=proof.first.text,
        delta_j=proof.step_map.delta_j_text,
        proof=proof,
    ).noting(f"traced with symbols; the map is known by {traced.how}", *_readings(tape))
    found = _but_for_rounding(found, traced, tape)
    return _measured_area(found, step, hamiltonian, points)


def _readings(tape: Tape) -> list[str]:
    notes = []
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


# -- agreement ------------------------------------------------------------------------------------


def _by_graph(kind: Duals, p_next: Node, q_next: Node) -> Any:
    def at(p: Dual, q: Dual, h: Dual) -> tuple[Any, Any]:
        made: dict[int, Any] = {}
        start = {"p": p, "q": q, "h": h}
        for node in in_order(p_next, q_next):
            x = [made[one.number] for one in node.inputs]
            match node.operation:
                case "symbol":
                    made[node.number] = start[node.value]
                case "number":
                    made[node.number] = kind.rational(node.value)
                case "pi":
                    made[node.number] = kind.pi()
                case "power":
                    made[node.number] = x[0].raised(node.value)
                case "add" | "subtract" | "multiply" | "divide" as name:
                    made[node.number] = x[0].combined(name, x[1])
                case name:
                    made[node.number] = x[0].applied(name)
        return made[p_next.number], made[q_next.number]

    return at


def _by_duals(step: Step) -> Any:
    def made(kind: Duals) -> Any:
        function = copied(step.function, kind)
        return lambda p, q, h: carried_step(step, function, p, q, h)

    return made


def _must_agree(step: Step, points: Sequence[Point], made: Any, how: str) -> None:
    """UntraceableError where our numbers and the user's floats part at a point.

    So it is where the code keeps a state, or takes another branch with floats.
    """
    kind, compared = Duals(), 0
    with kind.running():
        at = made(kind)
        for point in points:
            for h in _SIZES:
                try:
                    mine = step.at(float(point[0]), float(point[1]), float(h))
                except Exception:  # noqa: S112 - it fails there; other points may do
                    continue
                theirs = [x.value for x in at(*kind.state(*point), kind.rational(h))]
                compared += 1
                reach = 1 + max(map(abs, mine))
                if any(
                    abs(x - y) > _AGREES[how] * reach for x, y in zip(mine, theirs, strict=True)
                ):
                    where = f"p = {point[0]}, q = {point[1]}, h = {h}"
                    raise UntraceableError(f"with floats it does something else, at {where}")
    if not compared:
        raise UntraceableError("it fails at every point that is tried")


# -- measured -------------------------------------------------------------------------------------


def _of_measured(found: Measured) -> Finding:
    area, distance = found.area, found.distance
    exact = all(row.error <= 10 * row.error_noise for row in found.rows)
    order = None if distance.power is None else distance.power - 1
    vanishes, said = _area_said(found)
    if exact:
        told = "the map is the exact flow to its last digits"
    else:
        known = order is not None
        told = f"the map's order is {order}" if known else "its error follows no power of h"
    verdict = Verdict.MEASURED
    if order is not None and order < 1:
        verdict, told = Verdict.REFUTED, f"not a scheme for this H: {told}"
    elif (area.power is None and not vanishes) or (order is None and not exact):
        verdict = Verdict.UNDECIDED
    return Finding(
        verdict,
        f"{told}; {said}",
        found.how,
        order=area.power,
        area_preserving=True if vanishes else False if area.power is not None else None,
        convergence_order=order,
        order_known=order is not None or exact,
        largest=abs(found.largest.delta_j),
        probe_error=found.noise,
    )


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


# -- claims ---------------------------------------------------------------------------------------


def _with_claims(
    found: Finding, claims: Claims, step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]
) -> Finding:
    """REFUTED where a claim is, with the counterexample; UNDECIDED where one is not decided."""
    failed = broken(claims, found)
    false = [claim for claim in failed if claim[1] is False]
    if not failed and found.verdict is not Verdict.REFUTED:
        return found
    if not false and found.verdict is not Verdict.REFUTED:
        return replace(
            found,
            verdict=Verdict.UNDECIDED,
            reason=f"{failed[0][0]} is claimed and not decided: {found.reason}",
        )
    if false:
        name, _, known = false[0]
        reason = f"{name} is claimed; {known} ({found.reason})"
        found = replace(found, verdict=Verdict.REFUTED, reason=reason)
    else:
        name = "order 1"
    return replace(found, counterexample=_counterexample(name, claims, step, hamiltonian, points))


def _counterexample(
    name: str, claims: Claims, step: Step, hamiltonian: Hamiltonian, points: Sequence[Point]
) -> Counterexample | None:
    for how in ("duals", "floats"):
        try:
            whole = measured(step, hamiltonian, points, how)
            row = whole.largest
            if name == "det J ≡ 1":
                value = f"{row.delta_j:.6e} ± {row.delta_noise:.1e}"
                return Counterexample(*row.delta_at, row.h, "det J − 1", value, "0")
            area = name.startswith("ΔJ")
            power = (claims.area_order or 1) if area else (claims.order or 1) + 1
            at = whole.rows[-1].delta_at if area else whole.rows[-1].error_at
            return _too_slow(measured(step, hamiltonian, [at], how, FINER[how]), at, power, area)
        except Exception:  # noqa: S112 - the user's code may raise anything
            continue
    return None


def _too_slow(found: Measured, at: Point, power: int, area: bool) -> Counterexample | None:
    """Two step sizes between which a quantity shrinks by less than its power says.

    The largest of those at which that shows as plainly as it does anywhere.
    """
    pairs: list[tuple[float, Row, float, float, Row]] = []
    for large, small in pairwise(found.rows):
        (one, first), (two, second) = (_value(row, area) for row in (large, small))
        if one > 100 * first and two > 100 * second:
            allowed = one * float(small.h / large.h) ** power
            pairs.append((two / allowed, small, two, allowed, large))
    most = max((ratio for ratio, *_ in pairs), default=0.0)
    if most < _TOO_SLOW:
        return None
    _, row, value, allowed, before = next(pair for pair in pairs if pair[0] >= _PLAINLY * most)
    return Counterexample(
        *at,
        row.h,
        "|det J − 1|" if area else "the distance from the exact flow after one step",
        f"{value:.6e}",
        f"about {allowed:.2e} for O(h^{power}), by that at h = {before.h}",
    )


def _value(row: Row, area: bool) -> tuple[float, float]:
    return (abs(row.delta_j), row.delta_noise) if area else (row.error, row.error_noise)
