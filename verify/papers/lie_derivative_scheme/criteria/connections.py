"""How the criteria are connected: 2 forces 3 and 4, 3 forces neither, and 4 is not stronger.

On a fixed [0, T] with N = T/h: criterion 2 is max |ΔJ_k| = o(h), criterion 3 is MSE = o(h),
criterion 4 is Λ = o(1), as h → 0.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.papers.argument import NUMBERS, Argument, Check, Step, proof, refutation, steps
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
from verify.proof.assistant.shipped_theory import ShippedTheorem

SETTING = """Fix T, let h = T/N, and write `x_k` = `ΔJ_k`, k = 0 … N − 1, m = max |`x_k`|.
Criterion 2 is m = o(h), criterion 3 is MSE = (1/N) Σ `x_k²` = o(h), criterion 4 is Λ = Π (1 +
`x_k`) − 1 = o(1), h → 0."""
BY_MANY_STEPS = ShippedTheorem("Theorems", "error_over_many_steps")


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
    return proof(
        f"""
        MSE ≤ (max |`ΔJ_k`|)², so criterion 2 gives even MSE = o(h²); “higher-order infinitesimal”
        must be meant uniformly in k, else it fails

        {SETTING}

        - A mean is at most the greatest of its terms: ``MSE = (1/N) Σ_{{k}} x_k^2 ≤ m^2 = o(h^2)``,
          more than criterion 3 asks for. [Sums.sum_of_less; tried inequalities_of_friction,
          inequalities_of_not_uniform]
        - Criterion 2 must be read uniformly in k, as its maximum over [0, T]: for the map p' = p(1
          + q²), q' = q + h from (0, 0) one has `ΔJ_k` = (kh)² = O(h²) for each fixed k, but MSE →
          T⁴/5. [not_uniform_changes, mean_of_fourth_powers, not_uniform_check]
        - For a scheme whose step depends smoothly on (p, q, h) the uniform reading is no
          restriction: if ΔJ = o(h) at every point of a compact set, then its Taylor coefficients of
          h⁰ and h¹ vanish on it, and ΔJ = O(h²) uniformly.
        - The converse is false: MSE = o(h), and criterion 2 fails, for p' = p − h(q + p), q' = q +
          hp, where ``ΔJ = −h + h^2``. [friction_changes, friction_check]
        """,
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
    return proof(
        f"""
        {_TWO_IMPLIES_FOUR}

        {SETTING}

        - [two_implies_four]
        """,
        two_implies_four=_two_implies_four(friction),
    )


_TWO_IMPLIES_FOUR = "criterion 2 implies criterion 4, by |Λ| ≤ exp(T max|`ΔJ_k`|/h) − 1"


def _two_implies_four(friction: ExampleMap) -> list[Step]:
    return steps(
        """
        - Criterion 2 implies criterion 4: ``|Λ| ≤ e^(Nm) − 1 = e^(T m/h) − 1 → 0``.
          [Theorems.error_over_many_steps]
        - For all real `x_k`, more precisely, ``|Π_{k} (1 + x_k) − 1| ≤ e^(Σ_k |x_k|) − 1``.
          [Product.product_near_one_by_sum; tried inequalities_of]
        """,
        inequalities_of=inequalities_of(friction),
    )


def criterion_4_and_2(friction: ExampleMap = FRICTION) -> Argument:
    """Refute that 4 and 2 do not imply each other: 2, read uniformly in k, implies 4."""
    return refutation(
        f"""
        {_TWO_IMPLIES_FOUR}

        {SETTING}

        - [two_implies_four]

        The paper’s own scheme is smooth in (p, q, h), so that criterion 2 holds for each k only
        where it holds uniformly: for that scheme 2 implies 4.
        """,
        two_implies_four=_two_implies_four(friction),
    )


def criterion_4_and_3(
    friction: ExampleMap = FRICTION,
    alternating: Sequence[ExampleMap] = (TO_AND_FRO, TO_AND_FRO_ODD),
) -> Argument:
    """Prove that neither of criteria 3 and 4 implies the other."""
    return proof(
        f"""
        criterion 3 does not imply criterion 4 (an oscillator with friction has MSE = O(h²) and Λ →
        `e^(−T)` − 1), nor does 4 imply 3 (p' = −p (1 − √h q)/(1 + √h q), q' = −q)

        {SETTING}

        - MSE = o(h) does not imply criterion 4, nor does MSE = O(h²). The explicit Euler step of an
          oscillator with friction, p' = p − h(q + p), q' = q + hp, has ΔJ = −h + h² at every point,
          so ``MSE = h^2(1 − h)^2 = o(h)``, and ``Λ = (1 − h + h^2)^(T/h) − 1 → e^(−T) − 1``:
          criterion 3 calls a map nearly area-preserving that shrinks every area to a fraction
          `e^(−T)`. [shrinking]
        - In the other direction criterion 4 does not imply 3: for p' = −p (1 − √h q)/(1 + √h q), q'
          = −q from q = 1, det J is (1 − √h)/(1 + √h) and its reciprocal in turn, so Λ is 0 or
          −2√h/(1 + √h), which tends to 0, while MSE > 4h for even N. [to_and_fro]

        By Cauchy and Schwarz Σ |`x_k`| ≤ N √MSE = T √MSE/h, so |Λ| ≤ exp(T √MSE/h) − 1: MSE = o(h²)
        does imply criterion 4, and this is the right scale for criterion 3.
        """,
        shrinking=shrinking(friction),
        to_and_fro=to_and_fro(alternating),
    )


def right_criterion_3(friction: ExampleMap = FRICTION) -> Argument:
    """Prove that MSE = o(h²), and not MSE = o(h), is sufficient for criterion 4."""
    return proof(
        f"""
        MSE = o(h²) implies criterion 4, by |Λ| ≤ exp(T √MSE/h) − 1; MSE = o(h), and even MSE =
        O(h²), does not

        {SETTING}

        - By Cauchy and Schwarz ``(Σ_k |x_k|)^2 ≤ N^2 MSE``, so Σ |`x_k`| ≤ N √MSE = T √MSE/h.
          [tried inequalities_of]
        - ``|Π_{{k}} (1 + x_k) − 1| ≤ e^(Σ_k |x_k|) − 1``, which tends to 0 if √MSE = o(h).
          [Product.product_near_one_by_sum]
        - For an oscillator with friction, p' = p − h(q + p), q' = q + hp, MSE = O(h²), and Λ →
          `e^(−T)` − 1. [shrinking]

        All three criteria hold for every smoothly consistent scheme: it is the order of ΔJ that
        tells schemes apart.
        """,
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
    return refutation(
        f"""
        criterion 2 implies criterion 4 and not the other way round, so 4 is the weaker one

        {SETTING}

        - Criterion 2 implies 4: ``|Λ| ≤ e^(T m/h) − 1 → 0``. [Theorems.error_over_many_steps]
        - 4 does not imply 2, for a global number can vanish by cancellation. It does so for a
          smooth map near the identity: p' = p(1 + h(1/2 − q)), q' = q + h from (0, 0) on [0, 1] has
          `ΔJ_k` = h(1/2 − kh), hence max |`ΔJ_k`| = h/2, which is not o(h). [changes, example]
        - But Σ `ΔJ_k` = h/2, so that ``1 + Λ = Π_{{k}} (1 + x_k) ≤ e^(Σ_k x_k) = e^(h/2)``.
          [compensated_changes, Product.one_plus_below_exp]
        - `x_k` and `x_{{N−k}}` are opposite, so Λ > 0: ``1 + Λ ≥ (1 + h/2)(1 − Σ_{{k}} x_k^2) >
          1``, and Λ → 0. [tried small]
        - And it does so far from the identity: p' = −p (1 − √h q)/(1 + √h q), q' = −q. [to_and_fro]

        What can be said in favour of criterion 4 is of smooth steps and all times: see the other
        reading.
        """,
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
    return refutation(
        f"""
        criteria 3 and 4 imply each other in neither direction: p' = −p (1 − √h q)/(1 + √h q), q' =
        −q satisfies 4 and not 3

        {SETTING}

        - 4 does not imply 3: p' = −p (1 − √h q)/(1 + √h q), q' = −q from q = 1 has Λ → 0, and MSE >
          4h for even N. [to_and_fro]
        - Criterion 3 does not imply 4 (friction: ΔJ = −h + h²), so 3 and 4 cannot be ordered.
          [shrinking]
        """,
        to_and_fro=to_and_fro(alternating),
        shrinking=shrinking(friction),
    )


def shrinking(friction: ExampleMap) -> list[Check]:
    """Check ΔJ, the limit of Λ, and the numbers of an oscillator with friction."""
    return [friction.changes(), shrinks_to(), friction.check()]


def to_and_fro(alternating: Sequence[ExampleMap]) -> list[Check]:
    """Check ΔJ of the alternating map in two steps, and its numbers for even and odd N."""
    checks = [example.check() for example in alternating]
    return [alternating[0].changes(), turns_to_and_fro(), *checks]
