"""What Criteria 2 and 3 make of ΔJ and MSE, of lieη and of other maps."""

from verify.papers.argument import Argument, ArgumentTexts, Check, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.elementary_identities import product_of_determinants, squares_of_times
from verify.papers.lie_derivative_scheme import examples
from verify.papers.lie_derivative_scheme.consistency import small_determinant
from verify.papers.lie_derivative_scheme.criteria.connections import inequalities_of

_TEXTS = ArgumentTexts(__file__)

_ETAS = range(1, 4)


def criterion_2(not_small: examples.ExampleMap = examples.NOT_UNIFORM) -> Argument:
    """Prove that criterion 2, read uniformly, makes Λ tend to 0."""
    return _TEXTS.proof(
        "criterion_2",
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
    return _TEXTS.proof(
        "criterion_3", small_determinant=small_determinant(hamiltonian), vanishing=_vanishing()
    )


def criterion_3_any_map(friction: examples.ExampleMap = examples.FRICTION) -> Argument:
    """Refute it for any map: MSE = o(h), and every area shrinks to a fraction 1/e."""
    return _TEXTS.refutation(
        "criterion_3_any_map",
        friction_changes=friction.changes(),
        friction_check=friction.check(),
        shrinks_to=examples.shrinks_to(),
    )
