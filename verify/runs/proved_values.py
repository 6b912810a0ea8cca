"""The values of a run that follow from a proof, without a step.

Where ΔJ ≡ 0, ΔJ, MSE and Λ are exactly 0; where ΔJ does not depend on (p, q), Λ = (1 + ΔJ)^N − 1 is
enclosed by ball arithmetic. The error of a function that the scheme is shown to keep is 0.
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache

from verify import observables as kinds
from verify import schemes
from verify.algebra.enclosure import enclose
from verify.algebra.formula import parse
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.effort import answer_unless_long
from verify.errors import InputError
from verify.observables.observable import ENERGY
from verify.runs.estimates import BoundedValues
from verify.schemes.maps.step_map import StepMap
from verify.structures import Structure
from verify.structures.accumulated import read_accumulated
from verify.structures.first_integral import FirstIntegral


def prove_kept(
    step_map: StepMap, scheme: str, names: Iterable[str], ways: Mapping[str, Structure]
) -> BoundedValues:
    """Return the changes of functions, accumulated defects, and ways back that are shown to be 0.

    `ways`: the structure of each way back that is asked for.
    """
    structures: dict[str, Structure] = dict(ways)
    for observable in kinds.select({*names}):
        formula = observable.integral
        if formula not in ("", ENERGY):
            expression = parse(formula, source="integral")
            structures[observable.name] = FirstIntegral("integral", formula, expression)
        if observable.structure:
            system = step_map.hamiltonian
            structures[observable.name] = read_accumulated(observable.structure, system)
    return {
        name: (Fraction(0), Fraction(0))
        for name, structure in structures.items()
        if _is_kept(step_map, scheme, structure)
    }


# The change at the end and the greatest one are asked one after the other.
@lru_cache(maxsize=64)
def _is_kept(step_map: StepMap, scheme: str, structure: Structure) -> bool:
    from verify.proof.structures.structure_order import prove_structure  # takes long to import

    def question() -> bool:
        return prove_structure(step_map, structure, schemes.get(scheme)).is_kept is True

    try:
        return answer_unless_long(question, otherwise=False)
    except InputError:  # the exact flow does not keep it, or it is too involved
        return False


def prove_observables(
    step_map: StepMap, names: Iterable[str], h: Fraction, steps: int, digits: int
) -> BoundedValues:
    """Return the values, with bounds, of those of the named observables that need no run."""
    selected = {each.name: each for each in kinds.select({*names})}
    zero = Fraction(0), Fraction(0)
    values = {name: zero for name, observable in selected.items() if observable.vanishes(step_map)}
    constant = {
        name: observable.constant for name, observable in selected.items() if observable.constant
    }
    if step_map.preserves_area or not constant or step_map.uniform_delta_j is None:
        return values
    # 4 bits for each digit, 64 in reserve, and 2 log2(N), as the power N multiplies errors by N.
    bits = int(4 * digits) + 64 + 2 * steps.bit_length()
    delta_j = enclose(step_map.flat.ring, step_map.uniform_delta_j, {"h": h}, bits)
    if delta_j is None:
        return values
    with working_precision(bits):
        enclosures = {name: formula(delta_j, steps) for name, formula in constant.items()}
        return values | {
            n: midpoint_and_radius(x) for n, x in enclosures.items() if x and is_representable(x)
        }
