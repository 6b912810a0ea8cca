"""Whether the step of −h undoes that of h, Φ_(−h) ∘ Φ_h = id, by its Taylor series for one H.

A coefficient of Φ_(−h)(Φ_h(p, q)), exact, that does not vanish shows that the step is not
symmetric. That all do, as far as they are looked at, shows nothing; the verdict is UNDECIDED then.
"""

from dataclasses import dataclass

from verify.algebra.series.power_series import Derivatives, Series, at_moved
from verify.hamiltonians.canonical_field import CanonicalField
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import State
from verify.verdict import Verdict


@dataclass(frozen=True)
class Symmetry:
    """`power`: of h, the first in Φ_(−h) ∘ Φ_h − id that does not vanish; None where none is
    known."""

    verdict: Verdict
    reason: Prose
    power: int | None = None


def by_series(step_map: StepMap, most: int) -> Symmetry:
    """The coefficients of Φ_(−h) ∘ Φ_h up to h^most, for one H."""
    seen = -1
    for reach in dict.fromkeys([*range(2, most, 2), most]):  # terms multiply with every order
        expanded = step_map.series(reach)
        if expanded is None or not _begins_with_z(*expanded):
            return Symmetry(Verdict.UNDECIDED, prose("the map's Taylor series is not at hand"))
        field, step = expanded
        gaps = [undone(field, x, step) for x in step]
        for n in range(seen + 1, reach + 1):
            zero = [field.ring.decide(x.coefficients[n]).zero for x in gaps]
            if False in zero:
                shown_h = Formula(str(step_map.hamiltonian.expression))
                differs = f" `Φ_(−h)` ∘ `Φ_h` differs from the identity by O(`h^{n}`)"
                reason = prose("for H = ", shown_h, read_prose(differs))
                return Symmetry(Verdict.REFUTED, reason, n)
            if None in zero:
                undecided = read_prose(f"the coefficient of `h^{n}` is not decided")
                return Symmetry(Verdict.UNDECIDED, undecided)
        seen = reach
    alike = read_prose(f"`Φ_(−h)` ∘ `Φ_h` is the identity up to `h^{most}` at least")
    return Symmetry(Verdict.UNDECIDED, alike)


def _begins_with_z(field: CanonicalField, step: State) -> bool:
    pairs = zip(step, field.start, strict=True)
    return all(x.coefficients[0] == z for x, z in pairs)


def undone(field: CanonicalField, x: Series, step: State) -> Series:
    """Of a coordinate x, Σ (−h)ⁿ xₙ at the point z' that is given by its series, less its start.

    Where H depends on time, at t + h, at which the step of −h begins.
    """
    ring = field.ring
    moves = [
        (name, y - Series.of(ring, [z], y.most))
        for name, y, z in zip(field.names, step, field.start, strict=True)
    ]
    if field.timed:
        moves.append(("t", Series.of(ring, [ring.zero, ring.one], x.most)))
    total = Series.of(ring, [-x.coefficients[0]], x.most)
    for n, coefficient in enumerate(x.coefficients):
        moved = at_moved(Derivatives(ring, coefficient), moves, x.most).shifted(n)
        total = total - moved if n % 2 else total + moved
    return total
