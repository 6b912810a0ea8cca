"""What is said of a step that was measured: its verdict, in words, with what could not be seen."""

from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.exact import plain
from verify.hamiltonians.coordinates import PLANE
from verify.integrators.fitted_order import Fitted
from verify.integrators.probe import Measured, Trial, measured
from verify.integrators.results import Finding
from verify.integrators.wrapped import periods_told
from verify.prose import Number, Prose, prose, read_prose
from verify.verdict import Verdict

_SEEN = 1e-6  # a ΔJ that no tolerance makes
_NO_AREA = 1e-8  # a ΔJ above it, of no power of h, or a probe's error, leaves it undecided
_ROUNDING = 1e-12  # a ΔJ that rounded coefficients leave


def of_measured(found: Measured, trial: Trial) -> Finding:
    """What was found of the step, which is measured once more where dual numbers say too little.

    Raises StepError, or what the user's code raises.
    """
    told = _as_it_stands(found)
    small = told.order is not None and told.largest is not None and told.largest <= _SEEN
    if found.how == "duals" and found.opaque and small:
        told = _with_floats(told, trial)
    return _consistent(told)


def _as_it_stands(found: Measured) -> Finding:
    area, distance = found.area, found.distance
    exact = all(row.error <= 10 * row.error_noise for row in found.rows)
    order = None if distance.power is None else distance.power - 1
    preserving, said = _area_sentence(found)
    verdict, told = Verdict.MEASURED, _order_sentence(distance, exact)
    sure = distance.tail is None or distance.tail.small
    if order is not None and order < 1:
        verdict, told = Verdict.REFUTED, f"not a scheme for this H: {told}"
    elif preserving is None or (order is None and not exact):
        verdict = Verdict.UNDECIDED
    finding = Finding(
        verdict,
        read_prose(f"{told}; {said}"),
        found.how,
        order=area.power,
        area_preserving=preserving,
        convergence_order=order,
        order_decided=exact or (order is not None and sure),
        largest=abs(found.largest.delta_j),
        probe_error=found.noise,
        domain=(str(_where(found)),),
    )
    return finding.noting(*_notes(found))


def _order_sentence(distance: Fitted, exact: bool) -> str:
    if exact:
        return "the map is the exact flow to its last digits"
    if distance.power is None:
        return "its error follows no power of h"
    seen = f"as seen for h = {Fraction(distance.first)} … `{distance.last:.1e}`"
    if distance.power == 0:
        return f"its error after one step does not shrink with h, {seen}"
    return f"the map's order is {distance.power - 1}, {seen}"


def _area_sentence(found: Measured) -> tuple[bool | None, str]:
    """Whether ΔJ is 0 as far as can be seen, and what is seen of it."""
    if found.area.power is not None:
        return False, f"ΔJ shrinks as `h^{found.area.power}`"
    largest, noise = abs(found.largest.delta_j), found.noise
    most = max(largest, noise)  # a ΔJ of 0 is not known better than its noise
    shown = plain(Fraction(most), 2) if most >= 1e-3 else f"`{most:.1e}`"
    clear = found.how == "duals" and not found.opaque  # then ΔJ is that of the map itself
    least = 10 * noise
    if found.how == "duals" and (found.opaque or found.rounded):
        least = _NO_AREA if found.opaque else _ROUNDING
    if largest <= least and noise <= _NO_AREA:
        return True, f"|ΔJ| ≤ {shown} at every point and step"
    if found.ragged:
        return None, (
            f"|ΔJ| up to {shown} rises and falls as h shrinks, as what the tolerance of a loop "
            "leaves, and not as a truncation error"
        )
    if noise > _NO_AREA:
        return None, f"ΔJ is hidden by the probe's own error, `{noise:.1e}`"
    at = found.largest.h
    return False if clear else None, f"|ΔJ| up to {shown}, at h = {at}, follows no power of h"


def _consistent(found: Finding) -> Finding:
    """A map that agrees with the flow up to h^r has ΔJ = O(h^(r+1)): less is not of that order."""
    area, order = found.order, found.convergence_order
    if found.verdict is Verdict.REFUTED or area is None or order is None or area > order:
        return found
    but = f", which no map of order {order} does: a small mistake, or a tolerance"
    reason = prose(found.reason, but)
    return replace(found, verdict=Verdict.UNDECIDED, reason=reason, order_decided=False)


def _notes(found: Measured) -> list[Prose]:
    notes: list[str] = [prose("measured at ", _where(found), ", and nowhere else")]
    notes += periods_told(PLANE, found.periods)
    if found.how == "floats":
        unseen = f"about `{found.unseen:.0e}`"
        notes.append(
            f"in {found.numbers}: an error of p' − p or q' − q below {unseen} of them is not seen"
        )
    if found.opaque and found.area.power is not None and len(found.steady) < len(found.rows):
        grows = float(found.rows[len(found.steady)].h)
        notes.append(f"ΔJ grows again at h = `{grows:.1e}`, as where a loop with a tolerance ends")
    tail = found.distance.tail
    if tail is not None:
        notes.append(
            f"for h below `{tail.h:.1e}`, where its error is `{tail.error:.1e}`, that shrinks as "
            f"`h^{tail.power}` only, as the tolerance of a loop or a small mistake makes it"
        )
    return list(map(read_prose, notes))


def _where(found: Measured) -> Prose:
    """The points and steps that were looked at."""
    first, last = found.rows[0].h, found.rows[-1].h
    most = [max(abs(point[i]) for point in found.points) for i in (0, 1)]
    clock = f", {min(found.times)} ≤ t ≤ {max(found.times)}" if found.times else ""
    return prose(
        f"{len(found.points)} points, |p| ≤ {most[0]}, |q| ≤ {most[1]}{clock}, ",
        f"for h from {first} to ",
        Number(f"{float(last):.1e}"),
    )  # fmt: skip


def _with_floats(found: Finding, trial: Trial) -> Finding:
    """ΔJ of a step that compares values is taken from floats.

    A loop with a tolerance ends before the derivatives have settled: what dual numbers have is then
    the derivative of the operations that were done, and no more of the map.
    """
    other = _as_it_stands(measured(trial, "floats"))
    area = replace(
        found,
        verdict=other.verdict if found.verdict is Verdict.MEASURED else found.verdict,
        reason=prose(found.reason.partition("; ")[0], "; ", other.reason.partition("; ")[2]),
        order=other.order,
        area_preserving=other.area_preserving,
        largest=other.largest,
        probe_error=other.probe_error,
    )
    return area.noting("ΔJ is measured with floats, as a tolerance may hide in a smaller one")
