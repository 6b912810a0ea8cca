"""Which of the worst scenes are different from each other, and which are one scene again."""

import re
from collections.abc import Iterable

import sympy

from verify.exploration.sample import Sample
from verify.scenes.results.exploration import Worst
from verify.scenes.scene import Scene, scene_from
from verify.scenes.toml_file import toml_data

_NUMBERS = re.compile(r"(?<![*\w]{2})(?<!\w)[0-9]+")  # but exponents
_NEAR = 0.1  # of lg of a measure: a quarter more, or less


def scene_of(worst: Worst) -> Scene:
    """The scene that its text is of."""
    return scene_from(toml_data(worst.scene, "scene"), "scene")


def by_shape(found: Iterable[Worst]) -> list[Worst]:
    """The first of each shape of H, in the order given."""
    kept: dict[str, Worst] = {}
    for each in found:
        kept.setdefault(shape_of(each), each)
    return list(kept.values())


def shape_of(each: Worst) -> str:
    """H's terms without their coefficients, and without the other numbers but exponents."""
    return " + ".join(sorted(_terms(each)))


def different(found: Iterable[Worst]) -> list[Worst]:
    """In the order given, without those that are an earlier one again: about as bad, by the same
    scheme, and from the same start or by an H that has the same terms and more, or fewer."""
    kept: list[Worst] = []
    for each in found:
        if not any(_are_alike(each, other) for other in kept):
            kept.append(each)
    return kept


def _are_alike(a: Worst, b: Worst) -> bool:
    if abs(a.value - b.value) > _NEAR:
        return False
    one, other = (Sample.of(scene_of(each)) for each in (a, b))
    if one.scheme.name != other.scheme.name:
        return False
    of_one, of_other = _terms(a), _terms(b)
    same_start = one.run_arguments == other.run_arguments
    return same_start or of_one <= of_other or of_other <= of_one


def _terms(each: Worst) -> set[str]:
    terms = sympy.Add.make_args(scene_of(each).exact_hamiltonian().exact)
    primitive = (term.as_content_primitive()[1].as_coeff_Mul()[1] for term in terms)
    return {_NUMBERS.sub("n", str(term)) for term in primitive}
