"""Whether a user's step is a scheme for H, and what it preserves: proved, else measured."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.agreement import by_duals, must_agree, must_agree_but_for_rounding
from verify.integrators.claims import with_claims
from verify.integrators.defined import UNDEFINED, first_defined
from verify.integrators.faults import Fault, changed_since, examined
from verify.integrators.measured import of_measured
from verify.integrators.probe import Trial, measured
from verify.integrators.repeated import repeated
from verify.integrators.results import NOTHING, Claims, Finding
from verify.integrators.step import Step, StepError, why, within
from verify.integrators.step_probes import Point, dual_step
from verify.integrators.still_clock import measured_mistakes
from verify.integrators.tracing.clocks import clock_mistakes
from verify.integrators.tracing.domain import domain_of
from verify.integrators.tracing.functions import copied
from verify.integrators.tracing.readings_of_floats import readings
from verify.integrators.tracing.rounded_order import Rounded, rounded_orders
from verify.integrators.tracing.step_map import TracedMap, traced_map
from verify.integrators.tracing.trace import Node, Tape
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order import prove
from verify.prose import Prose, prose, read_prose
from verify.verdict import Verdict

POINTS: tuple[Point, ...] = (
    (Fraction(1, 3), Fraction(3, 5)),
    (Fraction(-1, 2), Fraction(7, 8)),
    (Fraction(1, 7), Fraction(6, 5)),
    (Fraction(3, 4), Fraction(-2, 5)),
    (Fraction(-1, 5), Fraction(-2, 5)),
)
_PROOF_SECONDS, _CLOCK_SECONDS = 30.0, 10.0
_KEPT = 0.4  # of the time that is left, for floats after dual numbers, which are slow
_FARTHEST = 10**9


def check_integrator(
    step: Step, hamiltonian: Hamiltonian, claims: Claims = NOTHING, start: Point | None = None
) -> Finding:
    """Runs the user's code. `start`: an initial value to look at beside those of `POINTS`.

    Raises InputError where a parameter of H has no value, or `start` is too far for floats.
    """
    hamiltonian.check_planar()
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a step needs one")
    for name, x in zip("pq", start or (), strict=False):
        if abs(x) > _FARTHEST:
            raise InputError(
                name, decimal(x, 3), f"is beyond {_FARTHEST:.0e}, for a step in floats"
            )
    step.moving = hamiltonian.time_dependent
    trial = Trial(step, hamiltonian, ((start,) if start else ()) + POINTS)
    faults, first = examined(step, trial.points)
    if not any(fault.fatal for fault in faults):
        faults += repeated(step, trial.points)
    if any(fault.fatal for fault in faults):
        return _no_step(trial, faults)
    provable = all(fault.allows is Verdict.PROVED for fault in faults)
    found = _examine(trial, provable)
    later = changed_since(step, first)
    if later:
        return _no_step(trial, [*faults, *later])
    if found.verdict is Verdict.REFUTED:
        found = found.noting(*_exchanged(trial, provable))
    found = replace(found, faults=tuple(fault.name for fault in faults))
    found = found.noting(*(fault.text for fault in faults), *_of_time(step))
    return _but_for(faults, with_claims(found, claims, trial))


def _but_for(faults: Sequence[Fault], found: Finding) -> Finding:
    """UNDECIDED where a fault lets no more stand; what is refuted stays so."""
    in_the_way = [fault for fault in faults if fault.allows is Verdict.UNDECIDED]
    if not in_the_way or not found.verdict.holds:
        return found
    reason = prose(in_the_way[0].text, " (", found.reason, ")")
    return replace(found, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False)


def _of_time(step: Step) -> list[str]:
    """What is said where H or the step does not depend on time."""
    if step.timed and not step.moving:
        return ["H does not depend on time: it is called with t = 0"]
    if step.moving and not step.timed:
        return ["it takes no t, and H depends on it: its force stands still"]
    return [] if step.timed else ["it takes no t: it is judged for a force without time alone"]


def _no_step(trial: Trial, faults: Sequence[Fault]) -> Finding:
    """REFUTED, but where its calls lack time, or H is defined at none of the points either."""
    fault = next(fault for fault in faults if fault.fatal)
    verdict, text = Verdict.REFUTED, prose(fault.text)
    if fault.fails:
        h, t = Fraction(1, 8), Fraction(1, 4)
        if trial.step.left <= 0:
            verdict = Verdict.UNDECIDED
        elif first_defined(trial.hamiltonian, trial.points, h, t) is None:
            verdict, text = Verdict.UNDECIDED, prose(text, UNDEFINED)
    return Finding(verdict, text, "calls", faults=tuple(fault.name for fault in faults))


def _examine(trial: Trial, provable: bool) -> Finding:
    step, notes = trial.step, list[Prose]()
    try:
        if provable and not step.foreign:
            with within(_PROOF_SECONDS, "its proof takes too long"):
                found, ends = _proved(trial)
            return found.noting(*_clock(trial.hamiltonian, *ends, found.convergence_order))
    except Exception as error:  # the user's code may raise anything
        notes.append(prose("no proof: ", why(error)))
    kept = 0.0 if step.foreign else _KEPT * max(step.left, 0)
    for how in step.ways:
        step.left += -kept if how == "duals" else kept
        try:
            if how == "duals":
                must_agree(trial, by_duals(step))
            told = of_measured(measured(trial, how), trial)
            return replace(told, notes=(*notes, *told.notes)).noting(*_still(trial, how, told))
        except Exception as error:  # as above
            notes.append(prose(f"not measured with {how}: ", why(error)))
    neither = prose("it can be neither traced nor measured")
    return Finding(Verdict.UNDECIDED, neither, "calls").noting(*notes)


def _still(trial: Trial, how: str, found: Finding) -> list[str]:
    """Which mistake its clock looks like; nothing where that cannot be measured in time."""
    try:
        return measured_mistakes(trial, how, found.convergence_order)
    except Exception:  # the user's code may raise anything
        return []


def _exchanged(trial: Trial, provable: bool) -> list[str]:
    """Whether it is a scheme when p and q stand in each other's place."""
    exchange = {"p": "q", "q": "p"}
    order = tuple(exchange.get(name, name) for name in trial.step.order)
    other = replace(trial, step=replace(trial.step, order=order))
    if not _examine(other, provable).verdict.holds:
        return []
    return [f"with arguments in the order {','.join(order)} it is a scheme for this H"]


# -- proved ---------------------------------------------------------------------------------------


def _proved(trial: Trial) -> tuple[Finding, tuple[Node, Node]]:
    """What is proved, and p' and q' as traced."""
    tape, step = Tape(), trial.step
    symbols = [tape.symbol(name) for name in ("pqht" if step.moving else "pqh")]
    symbols += [] if step.moving else [tape.rational(Fraction(0))]
    roots = dual_step(step, copied(step.function, tape), *symbols)
    tape.check()
    p_next, q_next = (x.node for x in roots)
    must_agree_but_for_rounding(trial, p_next, q_next)
    traced = traced_map(trial.hamiltonian, p_next, q_next)
    proof = prove(traced.step_map)
    found = Finding(
        proof.verdict,
        proof.reason,
        "proof",
        order=proof.order,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        order_decided=proof.convergence_decided,
        area_at_least=proof.first.power or MOST_ORDERS + 1,
        leading=proof.first.text,
        delta_j=proof.step_map.delta_j_text,
        proof=proof,
        domain=(proof.domain & domain_of(tape)).texts,
    ).noting(
        f"traced with symbols; the map {traced.how}",
        *readings(tape),
    )
    found = _but_for_rounding(found, traced, tape)
    return _measured_area(found, trial), (p_next, q_next)


def _clock(hamiltonian: Hamiltonian, p_next: Node, q_next: Node, order: int | None) -> list[str]:
    """Which mistake its clock looks like; a proof stands without where that takes too long."""
    try:
        with within(_CLOCK_SECONDS, "its clock takes too long"):
            return clock_mistakes(hamiltonian, p_next, q_next, order)
    except StepError:
        return []


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
        area_at_least=p.most,
        proof=None,
    )


def _is_scheme(better: Rounded) -> bool:
    return better.convergence is None or better.convergence >= 1


def _rounded_reason(found: Finding, better: Rounded, most: int) -> Prose:
    order = f"order {better.convergence}" if better.convergence is not None else f"order ≥ {most}"
    if found.area_preserving:
        area = "det J ≡ 1, proved"
    else:
        area = f"ΔJ = O(`h^{better.area if better.area is not None else most}`)"
    strictly = found.convergence_order
    exactly = f"; taken exactly, they make the order {strictly}" if strictly is not None else ""
    residue = decimal(better.residue, 2)
    return read_prose(
        f"{order} and {area}, but for the rounding of its coefficients, which leaves residues of "
        f"up to `{residue}`{exactly}"
    )


def _measured_area(found: Finding, trial: Trial) -> Finding:
    """What algebra leaves open of ΔJ is measured with dual numbers."""
    if found.area_preserving is not None or found.verdict is Verdict.REFUTED:
        return found
    try:
        other = of_measured(measured(trial, "duals"), trial)
    except Exception as error:  # the user's code may raise anything
        return found.noting(prose("not measured: ", why(error)))
    if other.verdict is not Verdict.MEASURED:
        return found
    return replace(
        other,
        convergence_order=found.convergence_order,
        order_decided=found.order_decided,
        reason=prose(other.reason, " (the coefficients of ΔJ are not decided: ", found.reason, ")"),
        notes=(*found.notes, *other.notes),
        leading=found.leading,
        area_at_least=found.area_at_least,
    )
