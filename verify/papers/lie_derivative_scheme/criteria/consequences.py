"""What Criteria 2 and 3 make of ΔJ and MSE, of lieη and of other maps."""

from verify.papers.argument import Argument, Check, proof, refutation, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.elementary_identities import product_of_determinants, squares_of_times
from verify.papers.lie_derivative_scheme import examples
from verify.papers.lie_derivative_scheme.consistency import small_determinant
from verify.papers.lie_derivative_scheme.criteria.connections import inequalities_of
from verify.proof.assistant.shipped_theory import ShippedTheorem

_ETAS = range(1, 4)
_OF_LIE = ShippedTheorem("Theorems", "determinant_of_lie_in_plane")


def criterion_2(not_small: examples.ExampleMap = examples.NOT_UNIFORM) -> Argument:
    """Prove that criterion 2, read uniformly, makes Λ tend to 0."""
    return proof(
        """
        if max |`ΔJ_k`| = o(h), then |Λ| ≤ exp(T max |`ΔJ_k`|/h) − 1 → 0 on [t₀, `t_end`]: areas
        change by a part of them that vanishes with h; and lieη of a smooth H does satisfy it

        - With m = max |`ΔJ_k`| and N = T/h ``|Λ| ≤ (1 + m)^N − 1 ≤ e^(T m/h) − 1``, which tends to
          0 if m = o(h). [Theorems.error_over_many_steps; tried inequalities_of]
        - By the chain rule 1 + Λ is the determinant of all N steps.
          [Differential.slopes_of_composition, product_of_determinants]
        - For lieη, of which the criterion speaks, ``ΔJ = h^(η+1) L + h^(η+2) R`` with smooth L and
          R, so that it is `O(h^(η+1))`. [Theorems.determinant_of_lie_in_plane, vanishing]
        - On compact sets L and R are bounded, so this is uniform there.
        - The maximum over k is meant: that each single `ΔJ_k` is o(h) is not enough for other maps,
          such as p' = p(1 + q²), q' = q + h, whose Λ over [0, 1] grows beyond all bounds.
          [not_small_changes, squares_of_times, Product.product_above_sum, not_small_check]
        """,
        inequalities_of=[
            inequalities_of(example) for example in (examples.FRICTION, examples.TO_AND_FRO)
        ],
        product_of_determinants=product_of_determinants(),
        vanishing=_vanishing(),
        not_small_changes=not_small.changes(),
        squares_of_times=squares_of_times(),
        not_small_check=not_small.check(),
    )


def _vanishing() -> Check:
    low = [x for eta in _ETAS for x in flow_of_every_hamiltonian(eta + 1).delta_j_gaps(eta)[:eta]]
    return vanishes("the coefficients of h … `h^η` in ΔJ of lieη, η = 1, 2, 3, generic H", *low)


def criterion_3(hamiltonian: bool = True) -> Argument:
    """Prove that MSE = o(h) and Λ → 0 for lieη, and for every smoothly consistent scheme."""
    return proof(
        """
        for the Lie derivative algorithm of a smooth H both sides of the implication hold: MSE =
        `O(h^(2η+2))`, and Λ = `O(h^η)` → 0, so that areas change by o(1)

        - For lieη ``ΔJ = O(h^(η+1))``; for every smoothly consistent scheme it is O(h²).
          [Theorems.determinant_of_lie_in_plane, small_determinant, vanishing]
        - It is so uniformly on compact sets, in one of which the run stays for small h.
        - A mean is at most its greatest term: ``MSE = O(h^(2η+2)) = o(h)``. [Sums.sum_of_less]
        - ``|Λ| ≤ e^(T O(h^η)) − 1 → 0``. [Theorems.error_over_many_steps]

        So whenever criterion 3 is satisfied the algorithm is nearly area-preserving; it always is,
        and the criterion excludes nothing.
        """,
        small_determinant=small_determinant(hamiltonian),
        vanishing=_vanishing(),
    )


def criterion_3_any_map(friction: examples.ExampleMap = examples.FRICTION) -> Argument:
    """Refute it for any map: MSE = o(h), and every area shrinks to a fraction 1/e."""
    return refutation(
        """
        for p' = p − h(q + p), q' = q + hp MSE = h²(1 − h)² = o(h), and over [0, 1] every area
        shrinks to a fraction that tends to 1/e

        - The explicit Euler step of an oscillator with friction has ΔJ = −h + h² at every point, so
          ``MSE = h^2(1 − h)^2 = o(h)``. [friction_changes, friction_check]
        - Yet over [0, 1] ``1 + Λ = (1 − h + h^2)^(1/h) → 1/e``. [shrinks_to]

        It is no scheme for Eq. 1, of which alone the criterion speaks.
        """,
        friction_changes=friction.changes(),
        friction_check=friction.check(),
        shrinks_to=examples.shrinks_to(),
    )
