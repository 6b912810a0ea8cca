"""A test of symmetry, Φ_(−h) ∘ Φ_h = id, by the Taylor series of a step for one H.

If an exact coefficient of Φ_(−h)(Φ_h(p, q)) − (p, q) does not vanish, the step is not symmetric. If
all examined coefficients vanish, nothing is proved, and the verdict is UNDECIDED.
"""

from dataclasses import dataclass

from verify.hamiltonians.canonical_field import PlainField
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.composition import compose, reverse, start_of
from verify.schemes.steps.step_algebra import State
from verify.verdict import Verdict


@dataclass(frozen=True)
class Symmetry:
    """A verdict on symmetry.

    `power`: the first power of h in Φ_(−h) ∘ Φ_h − id that does not vanish; None if all examined
    ones vanish or one is not decided.
    """

    verdict: Verdict
    reason: Prose
    power: int | None = None


def judge_symmetry(step_map: StepMap, most: int) -> Symmetry:
    """Judge symmetry by the coefficients of Φ_(−h) ∘ Φ_h up to h^most, for one H."""
    decided_up_to = -1
    # Low powers come first, as terms multiply with every order.
    for reach in dict.fromkeys([*range(2, most, 2), most]):
        expanded = step_map.series(reach)
        if expanded is None or not _begins_with_z(*expanded):
            return Symmetry(Verdict.UNDECIDED, prose("the map's Taylor series is not at hand"))
        field, step = expanded
        ends, starts = compose(field, list(map(reverse, step)), step), start_of(field, reach)
        residuals = [x - z for x, z in zip(ends, starts, strict=True)]
        for n in range(decided_up_to + 1, reach + 1):
            zero = [field.ring.decide(x.coefficients[n]).zero for x in residuals]
            if False in zero:
                hamiltonian = Formula(str(step_map.hamiltonian.expression))
                differs = f" `Φ_(−h)` ∘ `Φ_h` differs from the identity by O(`h^{n}`)"
                reason = prose("for H = ", hamiltonian, read_prose(differs))
                return Symmetry(Verdict.REFUTED, reason, n)
            # A later coefficient may be nonzero, but the first such power is then not known.
            if None in zero:
                undecided = read_prose(f"the coefficient of `h^{n}` is not decided")
                return Symmetry(Verdict.UNDECIDED, undecided)
        decided_up_to = reach
    alike = read_prose(f"`Φ_(−h)` ∘ `Φ_h` is the identity up to `h^{most}` at least")
    return Symmetry(Verdict.UNDECIDED, alike)


def _begins_with_z(field: PlainField, step: State) -> bool:
    pairs = zip(step, field.start, strict=True)
    return all(x.coefficients[0] == z for x, z in pairs)
