"""A test of symmetry, Φ_(−h) ∘ Φ_h = id, by the Taylor series of a step for one H.

If an exact coefficient of Φ_(−h)(Φ_h(p, q)) − (p, q) does not vanish, the step is not symmetric. If
all examined coefficients vanish, nothing is proved, and the verdict is UNDECIDED.
"""

from dataclasses import dataclass

from verify.algebra.power_series import Derivatives, Series, expand_at
from verify.hamiltonians.canonical_field import CanonicalField
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes.maps.step_map import StepMap
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
        residuals = [step_back_residual(field, x, step) for x in step]
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


def _begins_with_z(field: CanonicalField, step: State) -> bool:
    pairs = zip(step, field.start, strict=True)
    return all(x.coefficients[0] == z for x, z in pairs)


def step_back_residual(field: CanonicalField, x: Series, step: State) -> Series:
    """Return the series of Σ (−h)ⁿ xₙ(z') − x₀(z), a coordinate of Φ_(−h)(Φ_h(z)) − z.

    `x`: the series Σ hⁿ xₙ(z) of the coordinate in z'; `step`: that of z'. If H depends on time, xₙ
    is taken at t + h, where the step of −h begins.
    """
    ring = field.ring
    moves = [
        (name, y - Series.from_coefficients(ring, [z], y.most))
        for name, y, z in zip(field.names, step, field.start, strict=True)
    ]
    if field.timed:
        moves.append(("t", Series.from_coefficients(ring, [ring.zero, ring.one], x.most)))
    total = Series.from_coefficients(ring, [-x.coefficients[0]], x.most)
    for n, coefficient in enumerate(x.coefficients):
        shifted = expand_at(Derivatives(ring, coefficient), moves, x.most).shift(n)
        total = total - shifted if n % 2 else total + shifted
    return total
