"""How the criteria are connected: 2 forces 3 and 4, 3 forces neither, and 4 is not stronger.

On a fixed [0, T] with N = T/h: criterion 2 is max |ΔJ_k| = o(h), criterion 3 is MSE = o(h),
criterion 4 is Λ = o(1), as h → 0.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.papers.argument import NUMBERS, Argument, ArgumentTexts, Check, Step
from verify.papers.elementary_identities import compensated_changes, mean_of_fourth_powers
from verify.papers.exact_maps import Areas
from verify.papers.lie_derivative_scheme.examples import (
    COMPENSATED,
    FRICTION,
    NOT_UNIFORM,
    TO_AND_FRO,
    TO_AND_FRO_ODD,
    ExampleMap,
    shrinks_to,
    turns_to_and_fro,
)

_TEXTS = ArgumentTexts(__file__)


def inequalities_of(example: ExampleMap) -> Check:
    """Check MSE ≤ m², |Λ| ≤ Π(1 + |x|) − 1 and (Σ|x|)² ≤ N² MSE, in Fractions."""
    holds = all(map(inequalities_hold, (example.run(n) for n in example.steps)))
    return Check(
        f"MSE ≤ m², |Λ| ≤ Π(1 + |`x_k`|) − 1 and (Σ |`x_k`|)² ≤ N² MSE for “{example.name}”",
        holds,
        f"N = {', '.join(map(str, example.steps))}, exactly",
        NUMBERS,
    )


def inequalities_hold(areas: Areas) -> bool:
    """Return True if MSE ≤ m², |Λ| ≤ Π(1 + |x|) − 1 and (Σ|x|)² ≤ N² MSE."""
    # Every inequality is checked without roots or logarithms, so that Fractions decide it.
    count, total, product = len(areas.delta_j), Fraction(0), Fraction(1)
    for x in areas.delta_j:
        total += abs(x)
        product *= 1 + abs(x)
    return (
        areas.mse <= areas.largest**2
        and abs(areas.lam) <= product - 1
        and total**2 <= count**2 * areas.mse
    )


def criterion_2_implies_3(not_uniform: ExampleMap = NOT_UNIFORM) -> Argument:
    """Prove that criterion 2 is sufficient for criterion 3."""
    return _TEXTS.proof(
        "criterion_2_implies_3",
        inequalities_of_friction=inequalities_of(FRICTION),
        inequalities_of_not_uniform=inequalities_of(not_uniform),
        not_uniform_changes=not_uniform.changes(),
        mean_of_fourth_powers=mean_of_fourth_powers(),
        not_uniform_check=not_uniform.check(),
        friction_changes=FRICTION.changes(),
        friction_check=FRICTION.check(),
    )


def criterion_2_implies_4(friction: ExampleMap = FRICTION) -> Argument:
    """Prove that criterion 2, uniformly in k, is sufficient for criterion 4."""
    return _TEXTS.proof("criterion_2_implies_4", two_implies_four=_two_implies_four(friction))


def _two_implies_four(friction: ExampleMap) -> list[Step]:
    return _TEXTS.steps("_two_implies_four", inequalities_of=inequalities_of(friction))


def criterion_4_and_2(friction: ExampleMap = FRICTION) -> Argument:
    """Refute that 4 and 2 do not imply each other: 2, read uniformly in k, implies 4."""
    return _TEXTS.refutation("criterion_4_and_2", two_implies_four=_two_implies_four(friction))


def criterion_4_and_3(
    friction: ExampleMap = FRICTION,
    alternating: Sequence[ExampleMap] = (TO_AND_FRO, TO_AND_FRO_ODD),
) -> Argument:
    """Prove that neither of criteria 3 and 4 implies the other."""
    return _TEXTS.proof(
        "criterion_4_and_3", shrinking=shrinking(friction), to_and_fro=to_and_fro(alternating)
    )


def right_criterion_3(friction: ExampleMap = FRICTION) -> Argument:
    """Prove that MSE = o(h²), and not MSE = o(h), is sufficient for criterion 4."""
    return _TEXTS.proof(
        "right_criterion_3",
        inequalities_of=inequalities_of(friction),
        shrinking=shrinking(friction),
    )


def criterion_4_against_2(
    compensated: ExampleMap = COMPENSATED,
    alternating: Sequence[ExampleMap] = (TO_AND_FRO, TO_AND_FRO_ODD),
) -> Argument:
    """Refute that 4 is stronger than criterion 2: it is weaker."""
    between = [0 < compensated.run(n).lam < Fraction(1, n) for n in compensated.steps]
    small = Check(
        "0 < Λ < h for the compensated map", all(between), f"{len(between)} step sizes", NUMBERS
    )
    return _TEXTS.refutation(
        "criterion_4_against_2",
        changes=compensated.changes(),
        example=compensated.check(),
        compensated_changes=compensated_changes(),
        small=small,
        to_and_fro=to_and_fro(alternating),
    )


def criterion_4_against_3(
    friction: ExampleMap = FRICTION,
    alternating: Sequence[ExampleMap] = (TO_AND_FRO, TO_AND_FRO_ODD),
) -> Argument:
    """Refute that 4 is stronger than criterion 3, for one-step maps in general."""
    return _TEXTS.refutation(
        "criterion_4_against_3", to_and_fro=to_and_fro(alternating), shrinking=shrinking(friction)
    )


def shrinking(friction: ExampleMap) -> list[Check]:
    """Check ΔJ, the limit of Λ, and the numbers of an oscillator with friction."""
    return [friction.changes(), shrinks_to(), friction.check()]


def to_and_fro(alternating: Sequence[ExampleMap]) -> list[Check]:
    """Check ΔJ of the alternating map in two steps, and its numbers for even and odd N."""
    checks = [example.check() for example in alternating]
    return [alternating[0].changes(), turns_to_and_fro(), *checks]
