"""Whether a scheme is symmetric: whether the step of −h undoes that of h, Φ_(−h) ∘ Φ_h = id.

For every H, where its coefficients say so: a splitting that is a palindrome, stages that are.
A stage takes H at P = p + a (p' − p) and Q = q + b (q' − q). With −h, and the two ends exchanged,
its equations are the same but for 1 − a and 1 − b; so stages in reverse, with these, undo a step.

Otherwise by the Taylor series of Φ_(−h)(Φ_h(p, q)) for one H, with exact coefficients. One that
does not vanish shows that the scheme is not symmetric. That all do, as far as they are looked at,
shows nothing; the verdict is UNDECIDED then.
"""

from dataclasses import dataclass

from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Series, at_point, at_time, partials
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.by_conditions import first_wrong, shown
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes.conditions import Condition, WithSymmetry
from verify.schemes.every_hamiltonian import StageEquations
from verify.schemes.scheme import Scheme
from verify.schemes.step_map import StepMap
from verify.verdict import Verdict

# Neither even nor odd in p or q, so that no symmetry of H hides one that the scheme has not.
WITNESS = "p**2/2 + p**3/3 + q**3/5 - q**2/2 + q**4/7"
_MORE = 3  # powers of h beyond the scheme's order that are looked at


@dataclass(frozen=True)
class Symmetry:
    """PROVED: for every H that the scheme takes. REFUTED: for some H. `power`: of h, the first in
    Φ_(−h) ∘ Φ_h − id that does not vanish; None where none is known."""

    verdict: Verdict
    reason: Prose
    power: int | None = None
    conditions: tuple[Condition, ...] = ()


def prove_symmetry(scheme: Scheme) -> Symmetry:
    """By the scheme's coefficients; where they do not say that it is, by the series for one H."""
    every_h = scheme.every_h
    conditions = every_h.symmetry_conditions() if isinstance(every_h, WithSymmetry) else ()
    wrong = first_wrong(conditions)
    if conditions and wrong is None:
        mirrored = prose("its coefficients are a palindrome")
        return Symmetry(Verdict.PROVED, mirrored, None, conditions)
    if isinstance(every_h, StageEquations) and palindromic(every_h):
        return Symmetry(Verdict.PROVED, prose("its stages, in reverse, undo its step"))
    try:
        step_map = scheme.step_map(Hamiltonian.parse(WITNESS))
    except InputError:
        reason = prose("it does not take ", Formula(WITNESS))
        return Symmetry(Verdict.UNDECIDED, reason, None, conditions)
    found = by_series(step_map, scheme.order + _MORE)
    if wrong is None:
        return found
    reason = prose(found.reason, "; of its coefficients, ", shown(wrong), " does not hold")
    return Symmetry(found.verdict, reason, found.power, conditions)


def palindromic(stages: StageEquations) -> bool:
    """Whether the stages in reverse, each with its ends exchanged, are the stages."""
    rows = [(s.kick, s.drift, s.at_p, s.at_q) for s in stages.stages]
    undoing = [(kick, drift, 1 - p, 1 - q) for kick, drift, p, q in reversed(rows)]
    return rows == undoing


def by_series(step_map: StepMap, most: int) -> Symmetry:
    """The coefficients of Φ_(−h) ∘ Φ_h up to h^most, for one H."""
    seen = -1
    for reach in dict.fromkeys([*range(2, most, 2), most]):  # terms multiply with every order
        expanded = step_map.taylor(reach)
        if expanded is None:
            return Symmetry(Verdict.UNDECIDED, prose("the map's Taylor series is not at hand"))
        field, *step = expanded
        gaps = [undone(field.ring, x, *step) for x in step]
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


def undone(ring: Ring, x: Series, p: Series, q: Series) -> Series:
    """Of x = p or q, Σ (−h)ⁿ xₙ at the point (p, q) that is given by its series, less its start.

    Where H depends on time, at t + h, at which the step of −h begins.
    """
    timed, h = "t" in ring.variables, Series.of(ring, [ring.zero, ring.one], x.most)
    start: tuple[Poly, Poly] = (ring.variable("p"), ring.variable("q"))
    u, v = (s - Series.of(ring, [y], s.most) for s, y in zip((p, q), start, strict=True))
    total = Series.of(ring, [-x.coefficients[0]], x.most)
    for n, coefficient in enumerate(x.coefficients):
        if timed:
            moved = at_time(ring, coefficient, u, v, h).shifted(n)
        else:
            moved = at_point(partials(ring, coefficient), u, v).shifted(n)
        total = total - moved if n % 2 else total + moved
    return total
