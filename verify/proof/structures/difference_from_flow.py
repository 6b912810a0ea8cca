"""The leading coefficient of a structure's defect from the map's first difference from the flow.

Let the flow φ_h keep a structure T, and Φ_h = φ_h + hⁿ d + h^(n+1) e + …. Then Φ_h is φ_h after
z + hⁿ d + …, so that Φ*T − T begins with hⁿ times the derivative of T along d, which is the
coefficient of h in the defect of z + h d. Symmetry: Φ_(−h)Φ_h(z) − z is hⁿ (1 + (−1)ⁿ) d + …, and
for odd n it is h^(n+1) (2 e − f'd − D d) + …, where D is the derivative along f. All of it is
shorter than the series of the defect, which shows the same.
"""

from collections.abc import Mapping, Sequence

from verify.algebra.formula import symbol
from verify.algebra.power_series import Series
from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.canonical_field import PlainField
from verify.proof.expansion import Leading, series_of
from verify.proof.structures.structure_values import series_values
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.defect import DefectSeries
from verify.structures import Structure
from verify.structures.conformal import Conformal
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

ComponentLeading = tuple[str, Leading]  # a component's name, and the leading coefficient


def leading_by_difference(
    step_map: StepMap, structure: Structure, most: int
) -> ComponentLeading | None:
    """Return the leading coefficient of the defect of a structure that the flow keeps.

    None if the map's difference from the flow, looked at up to h^`most`, does not show it.
    """
    in_time = any(symbol("t") in x.free_symbols for x in structure.formulas)
    if in_time or isinstance(structure, Conformal | Reversible):
        return None
    series = series_of(step_map, most)
    if not isinstance(series, DefectSeries):
        return None
    agrees: bool | None = True
    n = step_map.flow_up_to  # the last power of h in which both agree
    while agrees and n < most:
        n += 1
        agrees = series.agrees(n)[0]
    if agrees is not False or n == 0:
        return None
    if isinstance(structure, Symmetric):
        # A map of order 0 begins with z + h (f + d): there h² has one more term, −d'd.
        return _of_symmetry(series, n) if n > 1 else None
    return _along(step_map, structure, n, series.flow, series.differences(n)[1])


def first_nonzero(n: int, parts: Mapping[str, tuple[Ring, Poly]]) -> ComponentLeading | None:
    """Return the coefficient of hⁿ in the first component where it is not 0, or is not shown to be;
    None if there is none."""
    undecided = None
    for name, (ring, x) in parts.items():
        decision = ring.decide(x)
        if decision.zero is not True:
            result = name, Leading(n, decision, (ring, x))
            if decision.zero is False:
                return result
            undecided = undecided or result
    return undecided


def _along(
    step_map: StepMap, structure: Structure, n: int, flow: PlainField, d: Sequence[Poly]
) -> ComponentLeading | None:
    """Return the derivative of the structure along d, times hⁿ; None if it may vanish."""
    state = tuple(Series(flow.ring, pair) for pair in zip(flow.start, d, strict=True))
    moved = StepMap(step_map.hamiltonian, flow, expand=lambda _: (flow, state))
    defect = structure.defect(series_values(moved, structure, 1))
    result = first_nonzero(n, {name: (x.ring, x.coefficients[1]) for name, x in defect.items()})
    return result if result and result[1].decision.zero is False else None


def _of_symmetry(series: "DefectSeries[PlainField]", n: int) -> ComponentLeading | None:
    """Return the leading coefficient of Φ_(−h)Φ_h(z) − z, if it is of hⁿ or h^(n+1)."""
    odd = n % 2
    _, later = series.differences(n + odd)
    ring, first = series.differences(n)
    flow = series.flow
    coefficients = [2 * d for d in first]
    for k, slope in enumerate(flow.slopes if odd else ()):
        pairs = zip(flow.gradient(slope), first, strict=True)
        turned = sum((a * d for a, d in pairs), ring.zero)
        coefficients[k] = ring.reduce(2 * later[k] - turned - flow.derive(first[k]))
    rows = zip(flow.names, coefficients, strict=True)
    result = first_nonzero(n + odd, {name: (ring, x) for name, x in rows})
    return result if result and result[1].decision.zero is False else None
