"""The finding from a measurement of a user's map: the verdict, the order, and the defect in words.

The defect is S = JᵀΩJ − Ω of the symplectic form Ω, in the plane ΔJ = det J − 1.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.arithmetic.exact import plain
from verify.integrators.measures.distances import Distances, PlaceOrder
from verify.integrators.measures.error_powers import ENOUGH_SLOPES
from verify.integrators.measures.measurement import REFUTING_RATIO
from verify.integrators.measures.measurement_notes import (
    describe_numbers,
    describe_places,
    note_places,
    note_sides,
    note_unseen,
)
from verify.integrators.measures.sides import Sides
from verify.integrators.measures.structure_measurement import StructureMeasurement
from verify.integrators.measures.survey import Request
from verify.integrators.places.trial_places import SIDE, USER
from verify.integrators.places.wrap_periods import describe_periods
from verify.integrators.results import Claims, Finding
from verify.integrators.trial import Trial
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Prose, join_prose, prose, read_prose
from verify.structures import structure_in
from verify.verdict import Verdict

# If the flow moves a shorter distance, in units of the place, an error would hardly show.
_MIN_VISIBLE_DISTANCE = 1e-3
_SHOWN_SLOPES = 8
ORDER_SEPARATOR = "; "  # stands in a reason between the order and the defect


@dataclass(frozen=True)
class _Order:
    """The measured `order`, None if no error is seen, or if no power has settled. `decided`: True
    if it is certain, or certainly lower than claimed. `domain`: the conditions for the order."""

    order: int | None
    decided: bool
    text: str
    domain: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def finding_from_measurement(
    trial: Trial, structure: StructureMeasurement | None, distances: Distances | None
) -> Finding:
    """Build the finding on the order of a step, and on Ω; for a map, without `distances`, on Ω
    alone, and for equations, without `structure`, on the order alone."""
    if structure is not None:
        finding = _finding_on_structure(trial, structure)
    else:
        places = describe_places(trial.step, trial.places)
        finding = Finding(
            Verdict.MEASURED, Prose(), "calls", trial.step.degrees, domain=(str(places),),
            places=tuple(trial.places),
        )  # fmt: skip
    if distances is not None:
        finding = _add_order(finding, trial, structure, distances)
    notes = note_sides(structure) if structure is not None else []
    return _check_consistency(finding.noting(*map(read_prose, notes)))


def _finding_on_structure(trial: Trial, structure: StructureMeasurement) -> Finding:
    """Return the finding on Ω; of a step, without its order."""
    step, reading = trial.step, structure.largest
    is_kept = structure.is_kept(trial.request.within)
    verdict = {True: Verdict.MEASURED, False: Verdict.REFUTED, None: Verdict.UNDECIDED}[is_kept]
    entry = step.entry_name(reading.largest[0]) if is_kept is False else ""
    text = _describe_structure(step, structure, is_kept, trial.request)
    # In several degrees of freedom det J = 1 is weaker than JᵀΩJ = Ω.
    volume = is_kept if step.degrees == 1 else is_kept or structure.volume_kept
    if trial.hamiltonian is None and is_kept is False:
        only_volume = "; det J is 1 all the same" if volume else ""
        text = f"it is not symplectic: the entry {entry} of S is not 0{only_volume}"
    places = tuple(dict.fromkeys(x.place for x in structure.readings))
    return Finding(
        verdict, read_prose(text), structure.how, step.degrees, symplectic=is_kept,
        area_preserving=volume, largest=reading.defect, probe_error=structure.noise,
        against=reading, entry=entry, domain=(str(describe_places(step, places)),),
        notes=tuple(map(read_prose, note_places(step, structure))), places=places,
    )  # fmt: skip


def _add_order(
    finding: Finding, trial: Trial, structure: StructureMeasurement | None, distances: Distances
) -> Finding:
    """Add the order of a step, with the verdict on it as a scheme."""
    step, is_kept = trial.step, finding.symplectic
    sides = Sides(step.names) if structure is None else structure.sides
    order = _judge_order(distances, sides, trial.claims)
    verdict, reason = Verdict.MEASURED, read_prose(order.text)
    # A scheme agrees with the flow up to h at least. With an order below 1 the map approximates
    # another flow, or none, however well it preserves Ω.
    if order.order is not None and order.decided and order.order < 1:
        system = "these equations" if trial.of_equations else "this H"
        verdict, reason = Verdict.REFUTED, prose(f"not a scheme for {system}: ", reason)
    elif not order.decided or (structure is not None and is_kept is None):
        verdict = Verdict.UNDECIDED
    notes = [*describe_periods(step.names, distances.periods), *order.notes]
    return replace(
        finding, verdict=verdict, how=distances.how,
        reason=join_prose(ORDER_SEPARATOR, [x for x in (reason, finding.reason) if x]),
        # `order` is that of the defect, which is 0 if the map preserves Ω.
        order=None if is_kept or structure is None else structure.power,
        convergence_order=order.order, order_decided=order.decided,
        domain=(*order.domain, *finding.domain),
    ).noting(*map(read_prose, [*notes, *note_unseen(step, distances)]))  # fmt: skip


# -- the structure --------------------------------------------------------------------------------


def _describe_structure(
    step: UserMap, structure: StructureMeasurement, is_kept: bool | None, request: Request
) -> str:
    """Describe S, or ΔJ in the plane: that it is 0 up to the noise, or else its power or size."""
    name = structure_in(step.degrees).symbol
    largest, noise = structure.largest.defect, structure.noise
    size = _format_size(largest)
    if request.within is not None:
        allowed_text = f"`{float(request.within):.1e}` that is allowed"
        if is_kept:
            return f"|{name}| ≤ {size} at every place, within the {allowed_text}"
        if is_kept is None:
            return (
                f"|{name}| is up to {size}, the probe's own error `{noise:.1e}`: "
                f"whether it is within the {allowed_text} is not seen"
            )
        return f"|{name}| is up to {size}, more than the {allowed_text}"
    if is_kept:
        numbers = describe_numbers(step) if structure.how == "floats" else "doubles"
        scope = "place and step size" if step.takes_step_size else "place"
        bound = _format_size(max(largest, noise))
        return f"|{name}| ≤ {bound} at every {scope}, within the noise of {numbers}"
    if is_kept is None and structure.ratio <= REFUTING_RATIO:
        if noise > 1e-7:
            return f"{name} is hidden by the probe's own error, `{noise:.1e}`"
        return f"|{name}| ≤ {size}, where the noise of its numbers is `{noise:.1e}`"
    if structure.power is not None:
        return f"{name} shrinks as `h^{structure.power}`"
    if structure.how == "duals" and structure.iterates:
        jumps = ", and jumps where the number of iterations changes" if structure.jumps else ""
        return (
            f"|{name}| is up to {size}, follows no power of h{jumps}: an iteration that "
            f"stops, at a tolerance of at least {size}"
        )
    return f"|{name}| is up to {size} and follows no power of h"


def _format_size(x: float) -> str:
    return plain(Fraction(x), 2) if 1e-3 <= x < 1e3 else f"`{x:.1e}`"


# -- the order ------------------------------------------------------------------------------------


def _judge_order(distances: Distances, sides: Sides, claims: Claims) -> _Order:
    places = distances.places
    if all(x.exact for x in places):
        if max(x.distance for x in places) < _MIN_VISIBLE_DISTANCE:
            return _Order(None, False, "its steps are too short for an error to show")
        return _Order(None, True, "the map is the exact flow to its last digits")
    resolved = [x for x in places if x.power is not None]
    unsettled = [x for x in places if not x.exact and x.power is None]
    unsettled = [x for x in unsettled if not resolved or _may_be_lower(x, resolved)]
    is_minority = len(unsettled) < max(
        2, len(places) / 4
    )  # at one place terms may cancel as h falls
    if is_minority and len(resolved) >= 2 and not any(x.place.source == USER for x in unsettled):
        unsettled = []
    if not resolved:
        return _Order(None, False, f"its error follows no power of h{_describe_slopes(unsettled)}")
    usual = Counter(x.power or 0 for x in resolved if x.place.source != SIDE) or Counter(
        x.power or 0 for x in resolved
    )
    # The order is that of most places; of two equally frequent powers it is the lower one.
    main = min(power for power, times in usual.items() if times == max(usual.values()))
    # Places of a lower power may lie on the other side of a comparison in the code. If one
    # comparison separates them from the others, the order is that of this side only.
    failing = [x for x in resolved if (x.power or 0) < main]
    passing = [x for x in places if x not in failing and x not in unsettled]
    domain: tuple[str, ...] = ()
    notes = list[str]()
    if failing:
        branch = sides.separating([x.place for x in passing], [x.place for x in failing])
        if branch is not None and not any(x.place.source == USER for x in failing):
            condition = sides.condition(branch)
            lowest_power = min(x.power or 0 for x in failing) - 1
            domain = (condition,)
            beyond_text = (
                f"agrees with the exact flow of this H up to `h^{max(lowest_power, 0)}` only"
            )
            beyond_text = beyond_text if lowest_power >= 0 else "is no scheme for this H"
            notes.append(f"the order is that for {condition}; beyond it the code does something "
                         f"else, which {beyond_text}")  # fmt: skip
            resolved = [x for x in resolved if x not in failing]
    lowest = min(resolved, key=lambda x: x.power or 0)
    # The error of one step is O(h^(r+1)) for a scheme of order r.
    order = (lowest.power or 0) - 1
    decided = not unsettled or (claims.order is not None and order < claims.order)
    text = _describe_order(order, lowest)
    if not decided:
        text += _describe_slopes(unsettled)
    tails = [x.tail for x in resolved if x.tail is not None]
    if tails:
        tail = max(tails, key=lambda x: x.error)
        law = "follows no power" if tail.power is None else f"shrinks as `h^{tail.power}` only"
        rounding_text = "the rounding of a coefficient leaves it"  # in its eighth digit, say
        iteration_text = "an iteration that stops at a tolerance leaves it"
        notes.append(
            f"for h below `{tail.h:.1e}`, where its error is `{tail.error:.1e}`, that {law}, as "
            f"{rounding_text if tail.power == 1 else iteration_text}"
        )
    return _Order(order, decided, text, domain, tuple(notes))


def _may_be_lower(unsettled: PlaceOrder, resolved: Sequence[PlaceOrder]) -> bool:
    """Return True if a place that has not settled may have a lower order than the others.

    If at another place a loop leaves an error (a tail), the place tells nothing. Beside a single
    settled place it may always be lower, unless enough slopes show the contrary.
    """
    if len(resolved) < 2 and len(unsettled.slopes) < ENOUGH_SLOPES:
        return True
    lowest_power = min(x.power or 0 for x in resolved)
    return unsettled.may_fall_below(lowest_power) and not any(x.tail for x in resolved)


def _describe_order(order: int, lowest: PlaceOrder) -> str:
    run = lowest.run
    range_text = (
        ""
        if run is None
        else f", as seen for h = {_format_step_size(run.first)} … `{run.last:.1e}`"
    )
    if order == -1:
        return f"its error after one step does not shrink with h{range_text}"
    if order == 0:
        return f"its error after one step is of order h{range_text}"
    return f"the map's order is {order}{range_text}"


def _format_step_size(h: float) -> str:
    fraction = Fraction(h)
    # Step sizes are halved from simple ones, so that the first ones are short binary fractions.
    return (
        str(fraction)
        if fraction.denominator <= 1024 and fraction.numerator <= 1024
        else f"`{h:.1e}`"
    )


def _describe_slopes(unsettled: Sequence[PlaceOrder]) -> str:
    """Format the slopes of one component at one place that has not settled."""
    example = next((x for x in unsettled if x.slopes), None)
    if example is None:
        return ""
    slopes = ", ".join(f"{x:.1f}" for x in example.slopes[:_SHOWN_SLOPES])
    return f" (the slopes of {example.component}' as h falls: {slopes})"


def _check_consistency(finding: Finding) -> Finding:
    """Make a finding UNDECIDED if the order of its defect is too low: a map that agrees with the
    flow up to h^r has a defect of O(h^(r+1))."""
    area, order = finding.order, finding.convergence_order
    if finding.verdict is Verdict.REFUTED or area is None or order is None or area > order:
        return finding
    but = f", which no map of order {order} does: a small mistake, or a tolerance"
    reason = prose(finding.reason, but)
    return replace(finding, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False)
