"""Explicit Runge–Kutta schemes for one H.

Where that depends on time, t is one more coordinate, of slope 1: stage i is taken at t + c_i h.

The same few lines, `RungeKutta.step`, are read in two ways: with ring elements they make the map,
stage by stage, and with power series in h its Taylor series.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.every_hamiltonian import RungeKutta
from verify.schemes.scheme import Scheme
from verify.schemes.stages import Point, Stages
from verify.schemes.step_algebra import series_in_plane
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
    clock = Fraction(standing) if standing is not None else None
    step = partial(tableau.changes, standing=clock)
    return StepMap(hamiltonian, (substep,), lambda most: series_in_plane(field, step, most))
