"""What a user's step or map keeps: the verdict on each structure, by proof or by measurement."""

import math
from dataclasses import replace
from fractions import Fraction

from verify.algebra.domain import FormulaDomain
from verify.integrators.measures.kept_measurement import KeptMeasurement
from verify.integrators.measures.measurement import REFUTING_RATIO
from verify.integrators.measures.measurement_notes import describe_numbers
from verify.integrators.measures.reading import KeptReading
from verify.integrators.results import KeptStructure
from verify.integrators.trial import counterexample_at, find_slow_reading
from verify.integrators.user_code.user_map import UserMap
from verify.proof.structures.structure_order import StructureProof
from verify.prose import Prose, prose, read_prose
from verify.structures import Structure
from verify.structures.reading import ClaimedStructure
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric
from verify.structures.volume import Volume
from verify.verdict import Verdict

# In natural units: a smaller defect of a code with a loop, which follows no power of h, may be what
# the loop leaves that ends at a tolerance.
_MAX_LOOP_DEFECT = 1e-5
_TURN_TOLERANCE, _MOST_TURNS = 1e-11, 1e6  # relative, of multiples of 2π; larger ones tell nothing


def from_proof(proof: StructureProof, domain: FormulaDomain) -> KeptStructure:
    """Return the structure as a proof for the traced step has it; `domain`: of the trace."""
    return KeptStructure(
        proof.structure, proof.verdict, proof.reason, "proof", proof.claimed, proof.is_kept,
        proof.order, proof.leading, proof.component, proof.telescopes, proof.potential,
        proof.domain & domain,
    )  # fmt: skip


def leave_open(claim: ClaimedStructure, reason: str) -> KeptStructure:
    """Return the structure without a verdict, for this reason."""
    return KeptStructure(claim.structure, Verdict.UNDECIDED, prose(reason), "calls", claim.order)


def combine(proved: KeptStructure | None, measured: KeptStructure) -> KeptStructure:
    """Return the verdict of a refuting proof, if there is one, with what was measured beside it."""
    if proved is None:
        return measured
    unseen = ", though it is too small to be seen in floats at the places that were tried"
    reason = prose(proved.reason, "" if measured.exact is False else unseen)
    return replace(proved, reason=reason, largest=measured.largest,
                   probe_error=measured.probe_error, counterexample=measured.counterexample,
                   way_back=measured.way_back)  # fmt: skip


def judge(
    step: UserMap,
    claim: ClaimedStructure,
    measurement: KeptMeasurement,
    within: Fraction | None,
) -> KeptStructure:
    """Judge a claim by its measurement; `within`: a defect that is allowed, in natural units."""
    structure, worst = claim.structure, measurement.largest
    vanishes = measurement.vanishes
    if claim.order is None and within is not None:
        vanishes = measurement.is_within(float(within))
    power = None if vanishes else measurement.power
    kept = KeptStructure(
        structure, Verdict.UNDECIDED, prose(), measurement.how, claim.order, vanishes, power,
        largest=None if worst is None else worst.largest[1].defect,
        probe_error=None if worst is None else worst.blur,
        component="" if worst is None or vanishes else worst.largest[0],
    )  # fmt: skip
    if worst is None or (vanishes is None and worst.ratio <= worst.clear_ratio):
        return replace(kept, reason=_hidden(structure, measurement))
    if vanishes:
        scope = "place and step size" if step.takes_step_size else "place"
        noise = f"the noise of {describe_numbers(step)}" if within is None else "what is allowed"
        return _with(
            kept, Verdict.MEASURED,
            f"`{structure.defect_formula}` is 0 at every {scope}, within {noise}",
        )  # fmt: skip
    if claim.order is not None:
        return _judge_order(step, kept, measurement, claim.order)
    if within is None and power is None and _may_be_a_loop(step, measurement, worst):
        return _with(kept, Verdict.UNDECIDED, _loop_text(structure, worst))
    text = f"`{structure.defect_formula}` shrinks as `h^{power}`"
    if power is None:
        text = f"`{structure.defect_formula}` is not 0"
    if vanishes is None:
        return _with(kept, Verdict.UNDECIDED, f"{text}: whether it is within what is allowed is "
                     "not seen")  # fmt: skip
    if _wraps(structure, measurement):
        return _with(kept, Verdict.UNDECIDED, "it leads back but for multiples of 2π, as where an "
                     "angle is reduced")  # fmt: skip
    if _turns_orientation(structure, measurement):
        return _with(kept, Verdict.UNDECIDED, "det J is −1: the size of a volume is kept, and its "
                     "orientation turned")  # fmt: skip
    name, x = worst.largest
    example = counterexample_at(step, worst.place, worst.h, _quantity(structure, name), str(x))
    return replace(_with(kept, Verdict.REFUTED, text), counterexample=example)


def _with(kept: KeptStructure, verdict: Verdict, text: str) -> KeptStructure:
    return replace(kept, verdict=verdict, reason=read_prose(text))


def _judge_order(
    step: UserMap, kept: KeptStructure, measurement: KeptMeasurement, claimed: int
) -> KeptStructure:
    formula, power = kept.structure.defect_formula, measurement.power
    if power is None and measurement.falls_as(claimed):
        return _with(kept, Verdict.MEASURED, f"`{formula}` shrinks as `h^{claimed}` or faster")
    if power is None:
        kept = _with(kept, Verdict.UNDECIDED, f"`{formula}` follows no power of h, as far as seen")
    elif power >= claimed and measurement.how == "floats" and not measurement.falls_as(claimed):
        return _with(kept, Verdict.UNDECIDED, f"`{formula}` shrinks as `h^{power}`, and more slowly"
                     " at the smallest step sizes")  # fmt: skip
    elif power >= claimed:
        return _with(kept, Verdict.MEASURED, f"`{formula}` shrinks as `h^{power}`")
    quantity = f"|{_quantity(kept.structure, kept.component)}|, in natural units,"
    example = find_slow_reading(step, measurement.ladder, claimed, quantity)
    if power is None:
        return replace(kept, counterexample=example)  # for a proof that refutes the order
    verdict = Verdict.UNDECIDED if example is None else Verdict.REFUTED
    text = f"`{formula}` shrinks as `h^{power}` only"
    return replace(_with(kept, verdict, text), counterexample=example)


def _hidden(structure: Structure, measurement: KeptMeasurement) -> Prose:
    noise = max(x.blur for x in measurement.readings)
    return read_prose(
        f"whether `{structure.defect_formula}` is 0 is hidden by the noise of its numbers, "
        f"`{noise:.1e}` of its natural size"
    )


def _may_be_a_loop(step: UserMap, measurement: KeptMeasurement, worst: KeptReading) -> bool:
    """Return True if an iteration that stops at a tolerance may leave the defect.

    With floats comparisons are not seen, so that only the size tells.
    """
    iterates = measurement.iterates or (measurement.how == "floats" and step.takes_step_size)
    return iterates and worst.largest[1].defect < _MAX_LOOP_DEFECT


def _loop_text(structure: Structure, worst: KeptReading) -> str:
    return (
        f"`{structure.defect_formula}` is up to `{worst.largest[1].defect:.1e}` of its natural "
        "size and follows no power of h, as what an iteration leaves that stops at a tolerance; "
        "--within allows a defect"
    )


def _wraps(structure: Structure, measurement: KeptMeasurement) -> bool:
    """Return True if the way back is off by multiples of 2π alone."""
    if not isinstance(structure, Reversible | Symmetric):
        return False
    components = [x for reading in measurement.seen for x in reading.components.values()]
    turns = [(x, x.value / (2 * math.pi)) for x in components if x.ratio > KeptReading.clear_ratio]
    return all(
        0.5 < abs(y) < _MOST_TURNS and abs(y - round(y)) < _TURN_TOLERANCE * abs(y)
        for _, y in turns
    )


def _turns_orientation(structure: Structure, measurement: KeptMeasurement) -> bool:
    """Return True if det J is −1 wherever it was measured, as where one momentum is turned."""
    return isinstance(structure, Volume) and structure.density == 1 and all(
        abs(x.value + 2) <= REFUTING_RATIO * x.noise
        for reading in measurement.seen
        for x in reading.components.values()
    )  # fmt: skip


def _quantity(structure: Structure, component: str) -> str:
    """Return the name of a component of the defect."""
    return f"{structure.defect_formula}{f', {component}' if component else ''}"
