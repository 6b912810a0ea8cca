"""Sentences on the criteria in another sense: for each fixed k, or for smooth steps and all times.

Criterion 2 is max |ΔJ_k| = o(h) in `verify.papers.lie_derivative_scheme.criteria.connections`, and
is read to the letter here, of each k by itself, which is weaker; and criterion 4 of all [0, t],
t ≤ T, at once.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.papers.argument import (
    NUMBERS,
    Argument,
    Check,
    Step,
    proof,
    refutation,
    steps,
    vanishes,
)
from verify.papers.elementary_identities import mean_of_fourth_powers, squares_of_times
from verify.papers.lie_derivative_scheme import examples
from verify.papers.lie_derivative_scheme.consistency import consistent_map
from verify.papers.lie_derivative_scheme.criteria.connections import shrinking, to_and_fro

_FIXED = (0, 1, 2)  # k


def _small_for_each_k(example: examples.ExampleMap) -> Check:
    """Check that ΔJ_k/h² does not depend on N for a few fixed k, so that each ΔJ_k is O(h²)."""
    ratios = [{example.run(n).delta_j[k] * n**2 for n in example.steps if n > k} for k in _FIXED]
    return Check(
        f"{example.name}: `ΔJ_k`/h² is the same for N = {', '.join(map(str, example.steps))}, k = "
        f"{', '.join(map(str, _FIXED))}",
        all(len(values) == 1 for values in ratios),
        ", ".join(str(min(values)) for values in ratios),
        NUMBERS,
    )


def _grows(example: examples.ExampleMap) -> Check:
    """Check that Λ ≥ Σ ΔJ_k ≥ N/8, which is unbounded, and that MSE does not tend to 0."""
    runs = [(n, example.run(n)) for n in example.steps]
    holds = all(
        run_areas.lam >= sum(run_areas.delta_j) >= Fraction(n, 8)
        and run_areas.mse >= Fraction(1, 12)
        for n, run_areas in runs
    )
    return Check(
        f"{example.name}: Λ ≥ Σ `ΔJ_k` ≥ N/8, MSE ≥ 1/12",
        holds,
        f"N = {', '.join(map(str, example.steps))}, exactly",
        NUMBERS,
    )


def criterion_2_implies_3_pointwise(
    not_uniform: examples.ExampleMap = examples.NOT_UNIFORM,
) -> Argument:
    """Refute 2 ⇒ 3 for each k alone: each ΔJ_k = O(h²), and MSE → 1/5."""
    return refutation(
        """
        for p' = p(1 + q²), q' = q + h from (0, 0) each `ΔJ_k` = (kh)² = O(h²), but over [0, 1] MSE
        → 1/5; for a step that depends smoothly on (p, q, h), as lieη does, the two senses agree

        - With `q_k` = kh one has ``ΔJ_k = (kh)^2``, for each fixed k a higher-order infinitesimal
          of h. [not_uniform_changes, small_for_each_k]
        - But the last steps of [0, 1] have kh near 1, and ``MSE = (1/N) Σ_{k} (kh)^4 → 1/5``.
          [mean_of_fourth_powers, not_uniform_check, grows]

        For a scheme whose step depends smoothly on (p, q, h) this cannot happen: if ΔJ = o(h) at
        every point of a compact set, its Taylor coefficients of h⁰ and h¹ vanish there, and ΔJ =
        O(h²) uniformly.
        """,
        not_uniform_changes=not_uniform.changes(),
        small_for_each_k=_small_for_each_k(not_uniform),
        mean_of_fourth_powers=mean_of_fourth_powers(),
        not_uniform_check=not_uniform.check(),
        grows=_grows(not_uniform),
    )


def criterion_4_and_2_pointwise(
    not_uniform: examples.ExampleMap = examples.NOT_UNIFORM,
    alternating: Sequence[examples.ExampleMap] = (examples.TO_AND_FRO, examples.TO_AND_FRO_ODD),
) -> Argument:
    """Prove that for each k alone 2 does not imply 4, nor 4 imply 2."""
    are_large = [abs(e.run(n).delta_j[0]) ** 2 * n >= 1 for e in alternating for n in e.steps]
    at_first = Check(
        "to and fro: |`ΔJ_0`| ≥ √h",
        all(are_large),
        f"{len(are_large)} step sizes, exactly",
        NUMBERS,
    )
    return proof(
        """
        read for each fixed k, criterion 2 does not imply criterion 4 (p' = p(1 + q²), q' = q + h),
        nor 4 criterion 2; but neither map is lieη, for which the two senses agree and 2 implies 4

        - 2 and not 4: for p' = p(1 + q²), q' = q + h from (0, 0) each `ΔJ_k` = (kh)² = O(h²).
          [not_uniform_changes, small_for_each_k]
        - But over [0, 1] ``Λ = Π_{k} (1 + (kh)^2) − 1 ≥ Σ_{k} (kh)^2 ≥ N/8``.
          [Product.product_above_sum, squares_of_times, not_uniform_check, grows]
        - 4 and not 2: p' = −p (1 − √h q)/(1 + √h q), q' = −q from q = 1 has Λ → 0 and ``|ΔJ_0| =
          2√h/(1 + √h) ≥ √h``. [to_and_fro, at_first]
        """,
        not_uniform_changes=not_uniform.changes(),
        small_for_each_k=_small_for_each_k(not_uniform),
        squares_of_times=squares_of_times(),
        not_uniform_check=not_uniform.check(),
        grows=_grows(not_uniform),
        to_and_fro=to_and_fro(alternating),
        at_first=at_first,
    )


def criterion_4_against_2_smooth(hamiltonian: bool = False) -> Argument:
    """Refute that 4 is stronger: on every [0, t] it is equivalent to 2 for steps z + hg + h²r.

    `hamiltonian`: as for `_steps_for_every_time`.
    """
    return refutation(
        f"""
        {_EQUIVALENT}: 4 is as strong as 2, and no stronger

        {_SETTING}

        - [steps_of_equivalence]
        """,
        steps_of_equivalence=_steps_of_equivalence(hamiltonian),
    )


def criterion_4_equals_2(hamiltonian: bool = False) -> Argument:
    """Prove that 4 on every [0, t] and 2 are equivalent for steps z + hg + h²r."""
    return proof(
        f"""
        {_EQUIVALENT}

        {_SETTING}

        - [steps_of_equivalence]
        """,
        steps_of_equivalence=_steps_of_equivalence(hamiltonian),
    )


_SETTING = "Let the orbit of z' = g(z) exist on [0, T]."
_EQUIVALENT = (
    "for steps z + hg(z) + h²r(z, h) with smooth g and r, criterion 4 on [0, t] for every t ≤ T "
    "implies criterion 2, and criterion 2 implies it"
)


def _steps_of_equivalence(hamiltonian: bool) -> list[Step]:
    return steps(
        """
        - [steps_for_every_time]
        - Criterion 2 implies criterion 4 on every [0, t]: ``|Λ| ≤ e^(t m/h) − 1 → 0``, m = max
          |`ΔJ_k`|. [Theorems.error_over_many_steps]
        """,
        steps_for_every_time=_steps_for_every_time(hamiltonian),
    )


def criterion_4_against_3_smooth(
    hamiltonian: bool = False, friction: examples.ExampleMap = examples.FRICTION
) -> Argument:
    """Prove for steps z + hg + h²r that 4 on every [0, t] implies 3, but not vice versa."""
    return proof(
        f"""
        for steps z + hg(z) + h²r(z, h) with smooth g and r, criterion 4 on [0, t] for every t ≤ T
        implies criterion 3, which always holds then, and is not implied by it

        {_SETTING}

        - [steps_for_every_time]
        - Criterion 3 always holds: the mean of `ΔJ_k²` is at most its maximum, O(h²).
          [Sums.sum_of_less]
        - Criterion 4 does not hold for the oscillator with friction, where div g = −1. [shrinking]
        """,
        steps_for_every_time=_steps_for_every_time(hamiltonian),
        shrinking=shrinking(friction),
    )


def _steps_for_every_time(hamiltonian: bool) -> list[Step]:
    """Show that criterion 4 on every [0, t] gives ΔJ = O(h²), for steps z + hg + h²r.

    `hamiltonian`: whether g is a Hamiltonian's, for which div g = 0 and there is nothing to show.
    """
    powers = consistent_map(hamiltonian)
    ring = next(iter(powers.values())).context()
    divergence = ring.gens()[ring.names().index("a_p")] + ring.gens()[ring.names().index("b_q")]
    none = divergence - divergence
    return steps(
        """
        - ``ΔJ = h div g + O(h^2)``, for any g. [vanishes]
        - So Σ log(1 + `ΔJ_k`) = Σ h div g(`z_k`) + O(h), and, as Φ converges to the orbit, over [0,
          t] ``Λ → e^(∫_0^t div g dt) − 1``.
        - If that is 0 for every t ≤ T, then div g = 0 along the orbit, div g(`z_k`) = O(h), and
          `ΔJ_k` = O(h²) uniformly: criteria 2 and 3 follow.
        """,
        vanishes=vanishes(
            "ΔJ of a generic map z + hg + h²r is h div g + O(h²), g generic",
            powers.get(1, none) - divergence,
            powers.get(0, none),
        ),
    )
