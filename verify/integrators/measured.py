"""What is said of a user's map that was measured: its verdict, in words, with where it was seen."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.arithmetic.exact import plain
from verify.integrators.measures.order import Distances, PlaceOrder
from verify.integrators.measures.sides import Sides
from verify.integrators.measures.slopes import ENOUGH
from verify.integrators.measures.structure import REFUTES, Structure
from verify.integrators.measures.survey import Request
from verify.integrators.places.place import SIDE, USER, Place
from verify.integrators.places.wrapped import periods_told
from verify.integrators.results import Claims, Finding
from verify.integrators.trial import Trial
from verify.integrators.user_code.number_type import DOUBLE
from verify.integrators.user_code.user_map import UserMap
from verify.prose import Number, Prose, joined, prose, read_prose
from verify.structures import structure_in
from verify.verdict import Verdict

_STILL = 1e-3  # units that the flow goes, with which an error would hardly show
_PRECISE = 3  # decimals of a number that is shown


@dataclass(frozen=True)
class _Order:
    """`order`: None where none is seen or none has settled. `decided`: whether it is no
    higher, and no lower than what is claimed."""

    order: int | None
    decided: bool
    said: str
    domain: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def finding_of(trial: Trial, structure: Structure, distances: Distances | None) -> Finding:
    """Its order, and whether it keeps Ω, where it was looked at; of a map the latter alone."""
    step, kept = trial.step, structure.kept(trial.request.within)
    said = _structure_said(step, structure, kept, trial.request)
    made = (
        _of_map(step, structure, kept, said)
        if distances is None
        else _of_step(trial, structure, distances, kept, said)
    )
    return _consistent(made.noting(*map(read_prose, _sides_noted(structure))))


def _of_map(step: UserMap, structure: Structure, kept: bool | None, said: str) -> Finding:
    verdict = {True: Verdict.MEASURED, False: Verdict.REFUTED, None: Verdict.UNDECIDED}[kept]
    if kept is False:
        alone = step.degrees > 1 and structure.volume_kept  # in the plane S is det J − 1
        volume = "; det J is 1 all the same" if alone else ""
        entry = step.entry(structure.largest.shown)
        said = f"it is not symplectic: the entry {entry} of S is not 0{volume}"
    return _base(step, structure, verdict, said, kept)


def _of_step(
    trial: Trial, structure: Structure, distances: Distances, kept: bool | None, said: str
) -> Finding:
    step, order = trial.step, _order(distances, structure.sides, trial.claims)
    verdict, told = Verdict.MEASURED, order.said
    if order.order is not None and order.decided and order.order < 1:
        verdict, told = Verdict.REFUTED, f"not a scheme for this H: {told}"
    elif kept is None or not order.decided:
        verdict = Verdict.UNDECIDED
    finding = _base(step, structure, verdict, f"{told}; {said}", kept)
    finding = replace(
        finding,
        order=None if kept else structure.power,
        convergence_order=order.order,
        order_decided=order.decided,
        domain=(*order.domain, *finding.domain),
    )
    notes = periods_told(step.names, distances.periods)
    return finding.noting(*map(read_prose, [*notes, *order.notes, *_unseen_noted(step, distances)]))


def _base(
    step: UserMap, structure: Structure, verdict: Verdict, said: str, kept: bool | None
) -> Finding:
    reading = structure.largest
    places = tuple(dict.fromkeys(x.place for x in structure.readings))
    return Finding(
        verdict,
        read_prose(said),
        structure.how,
        step.degrees,
        symplectic=kept,
        area_preserving=kept if step.degrees == 1 else True if kept else structure.volume_kept,
        largest=reading.defect,
        probe_error=structure.noise,
        against=reading,
        entry=step.entry(reading.shown) if kept is False else "",
        domain=(str(where_seen(step, places)),),
        notes=tuple(map(read_prose, _places_noted(step, structure))),
        places=places,
    )


# -- the structure --------------------------------------------------------------------------------


def _structure_said(
    step: UserMap, structure: Structure, kept: bool | None, request: Request
) -> str:
    """Whether S, or ΔJ in the plane, is 0 as far as can be seen, and what is seen of it."""
    name = structure_in(step.degrees).defect
    largest, noise = structure.largest.defect, structure.noise
    if request.within is not None:
        allowed = f"`{float(request.within):.1e}` that is allowed"
        if kept:
            return f"|{name}| ≤ {_size(largest)} at every place, within the {allowed}"
        if kept is None:
            return (
                f"|{name}| is up to {_size(largest)}, the probe's own error `{noise:.1e}`: "
                f"whether it is within the {allowed} is not seen"
            )
        return f"|{name}| is up to {_size(largest)}, more than the {allowed}"
    if kept:
        numbers = _numbers(step) if structure.how == "floats" else "doubles"
        at = "place and step size" if step.stepped else "place"
        most = _size(max(largest, noise))
        return f"|{name}| ≤ {most} at every {at}, within the noise of {numbers}"
    if kept is None and structure.worst.beyond <= REFUTES:
        if noise > 1e-7:
            return f"{name} is hidden by the probe's own error, `{noise:.1e}`"
        return f"|{name}| ≤ {_size(largest)}, where the noise of its numbers is `{noise:.1e}`"
    if structure.power is not None:
        return f"{name} shrinks as `h^{structure.power}`"
    if structure.how == "duals" and structure.iterates:
        jumps = ", and jumps where the number of iterations changes" if structure.jumps else ""
        return (
            f"|{name}| is up to {_size(largest)}, follows no power of h{jumps}: an iteration that "
            f"stops, at a tolerance of at least {_size(largest)}"
        )
    return f"|{name}| is up to {_size(largest)} and follows no power of h"


def _size(x: float) -> str:
    return plain(Fraction(x), 2) if 1e-3 <= x < 1e3 else f"`{x:.1e}`"


def _numbers(step: UserMap, doubles: str = "doubles") -> str:
    return doubles if step.numbers is DOUBLE else step.numbers.declared_as


# -- the order ------------------------------------------------------------------------------------


def _order(distances: Distances, sides: Sides, claims: Claims) -> _Order:
    places = distances.places
    if all(x.exact for x in places):
        if max(x.moved for x in places) < _STILL:
            return _Order(None, False, "its steps are too short for an error to show")
        return _Order(None, True, "the map is the exact flow to its last digits")
    resolved = [x for x in places if x.power is not None]
    loose = [x for x in places if not x.exact and x.power is None]
    loose = [x for x in loose if not resolved or _counts(x, resolved)]
    few = len(loose) < max(2, len(places) / 4)  # at one place terms may cancel as h falls
    if few and len(resolved) >= 2 and not any(x.place.source == USER for x in loose):
        loose = []
    if not resolved:
        return _Order(None, False, f"its error follows no power of h{_slopes_said(loose)}")
    usual = Counter(x.power or 0 for x in resolved if x.place.source != SIDE) or Counter(
        x.power or 0 for x in resolved
    )
    main = min(power for power, times in usual.items() if times == max(usual.values()))
    failing = [x for x in resolved if (x.power or 0) < main]
    passing = [x for x in places if x not in failing and x not in loose]
    domain: tuple[str, ...] = ()
    notes = list[str]()
    if failing:
        branch = sides.separating([x.place for x in passing], [x.place for x in failing])
        if branch is not None and not any(x.place.source == USER for x in failing):
            here = sides.condition(branch)
            least = min(x.power or 0 for x in failing) - 1
            domain = (here,)
            beyond = f"agrees with the exact flow of this H up to `h^{max(least, 0)}` only"
            beyond = beyond if least >= 0 else "is no scheme for this H"
            notes.append(f"the order is that for {here}; beyond it the code does something else, "
                         f"which {beyond}")  # fmt: skip
            resolved = [x for x in resolved if x not in failing]
    lowest = min(resolved, key=lambda x: x.power or 0)
    order = (lowest.power or 0) - 1
    decided = not loose or (claims.order is not None and order < claims.order)
    said = _order_said(order, lowest)
    if not decided:
        said += _slopes_said(loose)
    tails = [x.tail for x in resolved if x.tail is not None]
    if tails:
        tail = max(tails, key=lambda x: x.error)
        law = "follows no power" if tail.power is None else f"shrinks as `h^{tail.power}` only"
        rounded = "the rounding of a coefficient leaves it"  # in its eighth digit, say
        iterated = "an iteration that stops at a tolerance leaves it"
        notes.append(
            f"for h below `{tail.h:.1e}`, where its error is `{tail.error:.1e}`, that {law}, as "
            f"{rounded if tail.power == 1 else iterated}"
        )
    return _Order(order, decided, said, domain, tuple(notes))


def _counts(loose: PlaceOrder, resolved: Sequence[PlaceOrder]) -> bool:
    """Whether a place that has not settled may have a lower order than the others.

    Where a loop ends at a tolerance it tells nothing; beside a single other place it always may,
    unless its slopes show that it does not.
    """
    if len(resolved) < 2 and len(loose.slopes) < ENOUGH:
        return True
    least = min(x.power or 0 for x in resolved)
    return loose.may_fall_below(least) and not any(x.tail for x in resolved)


def _order_said(order: int, lowest: PlaceOrder) -> str:
    run = lowest.run
    seen = "" if run is None else f", as seen for h = {_step(run.first)} … `{run.last:.1e}`"
    if order == -1:
        return f"its error after one step does not shrink with h{seen}"
    if order == 0:
        return f"its error after one step is of order h{seen}"
    return f"the map's order is {order}{seen}"


def _step(h: float) -> str:
    exact = Fraction(h)
    return str(exact) if exact.denominator <= 1024 and exact.numerator <= 1024 else f"`{h:.1e}`"


def _slopes_said(loose: Sequence[PlaceOrder]) -> str:
    """The slopes that have not settled, of one component at one place."""
    shown = next((x for x in loose if x.slopes), None)
    if shown is None:
        return ""
    slopes = ", ".join(f"{x:.1f}" for x in shown.slopes[:8])
    return f" (the slopes of {shown.component}' as h falls: {slopes})"


def _consistent(finding: Finding) -> Finding:
    """A map that agrees with the flow up to h^r has a defect of O(h^(r+1)): less is not of that
    order."""
    area, order = finding.order, finding.convergence_order
    if finding.verdict is Verdict.REFUTED or area is None or order is None or area > order:
        return finding
    but = f", which no map of order {order} does: a small mistake, or a tolerance"
    reason = prose(finding.reason, but)
    return replace(finding, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False)


# -- where ----------------------------------------------------------------------------------------


def where_seen(step: UserMap, places: Sequence[Place]) -> Prose:
    """The places and step sizes that were looked at."""
    n = step.degrees
    ranges = []
    for name, part in (("p", slice(0, n)), ("q", slice(n, 2 * n))):
        most = max(max(abs(x) for x in place.z[part]) for place in places)
        ranges.append(f"|{name}| ≤ {_plain(most)}")
    if step.moving:
        times = [place.t for place in places]
        ranges.append(f"{_plain(min(times))} ≤ t ≤ {_plain(max(times))}")
    count = f"{len(places)} place" + ("s" if len(places) != 1 else "")
    parts = [count, *ranges]
    steps = [place.step for place in places if place.step]
    if steps:
        parts.append(f"h ≤ {_plain(max(steps))}")
    return prose(joined(", ", parts))


def _plain(x: Fraction) -> str:
    if x.denominator <= 1000 and abs(x.numerator) < 10**5:
        return str(x)
    return Number(f"{float(x):.{_PRECISE}g}")


def _places_noted(step: UserMap, structure: Structure) -> list[str]:
    places = list(dict.fromkeys(x.place for x in structure.readings))
    kind = "with dual numbers" if structure.how == "duals" else f"in {_numbers(step, 'floats')}"
    notes = [f"measured {kind} at {where_seen(step, places)}, and nowhere else"]
    if structure.blind:
        each = [
            ", ".join(f"{name} = `{x}`" for name, x in zip(step.names, r.place.z, strict=True))
            + f" (`{r.blur:.1e}`)"
            for r in structure.blind[:4]
        ]
        notes.append(
            f"left out, as the probe's own error is not small against 1: {'; '.join(each)}"
        )
    if structure.lost:
        notes.append(f"at {len(structure.lost)} calls it returned no state: {structure.lost[0]}")
    return notes


def _sides_noted(structure: Structure) -> list[str]:
    far = list(structure.sides.far)
    beyond = [x.place for x in structure.readings if x.place.source == SIDE]
    notes = []
    if beyond:
        notes.append(
            f"{len(set(beyond))} of them lie on sides of comparisons that the others do not reach"
        )
    if far:
        notes.append(
            f"it compares, and may do something else, where {'; '.join(far[:3])}: not looked at"
        )
    return notes


def _unseen_noted(step: UserMap, distances: Distances) -> list[str]:
    if distances.how != "floats":
        return []
    unseen = max(x.unseen for x in distances.places)
    return [
        f"in {_numbers(step, 'floats')}: an error of p' − p or q' − q below about `{unseen:.0e}` "
        "of them is not seen"
    ]
