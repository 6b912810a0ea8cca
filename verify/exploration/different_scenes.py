"""The comparison of the worst scenes, which tells different ones from near repetitions."""

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
    """Parse the scene from its text."""
    return scene_from(toml_data(worst.scene, "scene"), "scene")


def select_by_shape(scenes: Iterable[Worst]) -> list[Worst]:
    """Return the first scene of each shape of H, in the given order."""
    first_of_shape: dict[str, Worst] = {}
    for each in scenes:
        first_of_shape.setdefault(shape_of(each), each)
    return list(first_of_shape.values())


def shape_of(each: Worst) -> str:
    """Return H's terms without coefficients, and with all numbers but exponents replaced by n."""
    return " + ".join(sorted(_terms(each)))


def select_different(scenes: Iterable[Worst]) -> list[Worst]:
    """Return the scenes in the given order, without near repetitions of an earlier one.

    Two scenes are alike if they are about as bad, have the same scheme, and have the same start or
    an H whose terms include those of the other.
    """
    selected: list[Worst] = []
    for each in scenes:
        if not any(_are_alike(each, other) for other in selected):
            selected.append(each)
    return selected


def _are_alike(a: Worst, b: Worst) -> bool:
    # By logarithms, as values are: equal badness is a matter of a factor.
    if abs(a.value - b.value) > _NEAR:
        return False
    one, other = (Sample.from_scene(scene_of(each)) for each in (a, b))
    if one.scheme.name != other.scheme.name:
        return False
    of_one, of_other = _terms(a), _terms(b)
    same_start = one.run_arguments == other.run_arguments
    return same_start or of_one <= of_other or of_other <= of_one


def _terms(each: Worst) -> set[str]:
    terms = sympy.Add.make_args(scene_of(each).exact_hamiltonian().exact)
    # The content of a term is its rational factor; what remains is the term's shape.
    primitive = (term.as_content_primitive()[1].as_coeff_Mul()[1] for term in terms)
    return {_NUMBERS.sub("n", str(term)) for term in primitive}
