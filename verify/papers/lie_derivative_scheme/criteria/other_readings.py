"""Sentences on the criteria in another sense: for each fixed k, or for smooth steps and all times.

Criterion 2 is max |ΔJ_k| = o(h) in `verify.papers.lie_derivative_scheme.criteria.connections`, and
is read to the letter here, of each k by itself, which is weaker; and criterion 4 of all [0, t],
t ≤ T, at once.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.papers.argument import NUMBERS, Argument, ArgumentTexts, Check, Step, vanishes
from verify.papers.elementary_identities import mean_of_fourth_powers, squares_of_times
from verify.papers.lie_derivative_scheme import examples
from verify.papers.lie_derivative_scheme.consistency import consistent_map
from verify.papers.lie_derivative_scheme.criteria.connections import shrinking, to_and_fro

_TEXTS = ArgumentTexts(__file__)

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
    return _TEXTS.refutation(
        "criterion_2_implies_3_pointwise",
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
    return _TEXTS.proof(
        "criterion_4_and_2_pointwise",
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
    return _TEXTS.refutation(
        "criterion_4_against_2_smooth", steps_of_equivalence=_steps_of_equivalence(hamiltonian)
    )


def criterion_4_equals_2(hamiltonian: bool = False) -> Argument:
    """Prove that 4 on every [0, t] and 2 are equivalent for steps z + hg + h²r."""
    return _TEXTS.proof(
        "criterion_4_equals_2", steps_of_equivalence=_steps_of_equivalence(hamiltonian)
    )


def _steps_of_equivalence(hamiltonian: bool) -> list[Step]:
    return _TEXTS.steps(
        "_steps_of_equivalence", steps_for_every_time=_steps_for_every_time(hamiltonian)
    )


def criterion_4_against_3_smooth(
    hamiltonian: bool = False, friction: examples.ExampleMap = examples.FRICTION
) -> Argument:
    """Prove for steps z + hg + h²r that 4 on every [0, t] implies 3, but not vice versa."""
    return _TEXTS.proof(
        "criterion_4_against_3_smooth",
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
    return _TEXTS.steps(
        "_steps_for_every_time",
        vanishes=vanishes(
            "ΔJ of a generic map z + hg + h²r is h div g + O(h²), g generic",
            powers.get(1, none) - divergence,
            powers.get(0, none),
        ),
    )
