"""Explicit Runge–Kutta schemes for one H.

Where that depends on time, t is one more coordinate, of slope 1: stage i is taken at t + c_i h.

The same few lines, `RungeKutta.step`, are read in two ways: with ring elements they make the map,
stage by stage, and with power series in h its Taylor series.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify.algebra.series.power_series import Series, at_point, at_time, partials
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.vector_field import VectorField
from verify.schemes.every_hamiltonian import RungeKutta
from verify.schemes.scheme import Scheme
from verify.schemes.stages import Point, Stages
from verify.schemes.step_map import StepMap, Substep


def explicit(name: str, tableau: RungeKutta, *, order: int, source: str) -> Scheme:
    """The scheme of these coefficients."""
    return Scheme(
        name=name,
        order=order,
        area_preserving=False,
        explicit=True,
        symmetric=False,
        source=source,
        build=lambda hamiltonian: runge_kutta_map(hamiltonian, tableau),
        every_h=tableau,
    )


def runge_kutta_map(
    hamiltonian: Hamiltonian, tableau: RungeKutta, standing: int | None = None
) -> StepMap:
    """The step map, for any H, in stages.

    `standing`: the clock stands at t + so many h, which is wrong (see
    `verify.schemes.methods.user.wrong_clocks`); None for the right one.
    """
    field, _ = hamiltonian.field()
    stages = Stages(field, len(tableau.weights))
    ring, stands = stages.ring, field.timed and standing is not None
    start = stages.start
    if stands:
        start = (*start[:2], start[2] + ring.constant(Fraction(standing or 0)) * ring.variable("h"))

    def slope(point: Point) -> Point:
        found = stages.slope(point)
        return (*found[:2], ring.zero) if stands else found

    def moved(weights: Sequence[Fraction], slopes: Sequence[Point]) -> Point:
        point = start
        for w, slope in zip(weights, slopes, strict=True):
            part = ring.constant(w) * ring.variable("h")
            point = tuple(x + part * u for x, u in zip(point, slope, strict=True))
        return point

    p_next, q_next, *_ = tableau.step(slope, moved)
    substep = Substep(stages.field, p_next, q_next)
    return StepMap(
        hamiltonian, (substep,), lambda most: (field, *taylor(field, tableau, most, standing))
    )


def taylor(
    field: VectorField, tableau: RungeKutta, most: int, standing: int | None = None
) -> tuple[Series, Series]:
    """The Taylor series of p' and q' up to h^most; `standing` as above."""
    ring = field.ring
    names = ("p", "q", "t") if field.timed else ("p", "q")
    start = [Series.of(ring, [ring.variable(name)], most) for name in names]
    force = [-field.h_q, field.h_p]
    gradient = [partials(ring, x) for x in force]
    stands = field.timed and standing is not None
    pace = Series.of(ring, [] if stands else [ring.one], most)
    begin = list(start)
    if stands:
        begin[2] += Series.of(ring, [ring.zero, ring.constant(Fraction(standing or 0))], most)

    def moved(weights: Sequence[Fraction], slopes: Sequence[list[Series]]) -> list[Series]:
        result = []
        for i, x in enumerate(begin):
            total = Series.of(ring, [], most)
            for w, k in zip(weights, slopes, strict=True):
                total += k[i].times(w)
            result.append(x + total.shifted(1))
        return result

    def slope(point: Sequence[Series]) -> list[Series]:
        u, v, *w = (x - x0 for x, x0 in zip(point, start, strict=True))
        if w:
            return [*(at_time(ring, x, u, v, w[0]) for x in force), pace]
        return [at_point(partial, u, v) for partial in gradient]

    p, q, *_ = tableau.step(slope, moved)
    return p, q
