"""Regions under driven maps: points, areas and the exact flow, each held against something else."""

from fractions import Fraction

import numpy as np
import pytest

from verify import arithmetic as number_systems
from verify.flows.points import exact_points
from verify.flows.solution import exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.many_points import PointMap
from verify.runs.requested_run import run
from verify.scenes.region_sections import PlacedShape
from verify.scenes.results.regions import EXACT_FLOW, FlowImage
from verify.studies.regions.region_image import carry

DRIVEN = Hamiltonian.parse("p**2/2 - (1 + cos(2*t)/2)*cos(q)")
T0, H, STEPS = Fraction(1, 3), Fraction(1, 20), 30
Q = np.array([0.5, 1.25, -0.75, 0.125, 1.5])
P = np.array([0.25, -0.5, 0.75, 1.0, 0.0])


@pytest.mark.parametrize("name", ["float64", "fixed", "mpfr"])
def test_points_go_as_runs_do(name: str) -> None:
    """Of each by itself, in mpfr and from the same time."""
    made = number_systems.get(name, 25)
    carried = PointMap(DRIVEN, "lie2", step_size=H, steps=STEPS, t0=T0, arithmetic=made)
    p, q = (x if name == "float64" else [made.number(Fraction(v)) for v in x] for x in (P, Q))
    found = carried(p=p, q=q)
    within = Fraction(1, 10 ** (13 if name == "float64" else 20))
    for k, (p, q) in enumerate(zip(P, Q, strict=True)):
        one = run(DRIVEN, "lie2", p=p, q=q, t0=T0, step_size=H, steps=STEPS,
                  arithmetic="mpfr", digits=30, observables=())  # fmt: skip
        for z in ("p", "q"):
            value = found[z][k]
            own = Fraction(float(value)) if name == "float64" else made.exact(value)
            assert abs(own - Fraction(one.values[z].value)) < within


def test_another_start_of_the_clock_is_another_map() -> None:
    made = number_systems.get("float64", 17)
    here, there = (
        PointMap(DRIVEN, "lie2", step_size=H, steps=STEPS, t0=t0, arithmetic=made)(p=P, q=Q)
        for t0 in (T0, Fraction(0))
    )
    assert np.abs(here["p"] - there["p"]).min() > 1e-3


@pytest.mark.left_to_ci
def test_the_exact_flow_of_many_points_is_that_of_each() -> None:
    times = [Fraction(-1), Fraction(0), Fraction(3, 2), Fraction(5)]
    found = exact_points(DRIVEN, {"p": P, "q": Q}, times, T0)
    for k, time in enumerate(times):
        for i, (p, q) in enumerate(zip(P, Q, strict=True)):
            true = exact_solution(DRIVEN, p=Fraction(p), q=Fraction(q), time=time, digits=25, t0=T0)
            assert abs(Fraction(found.points["p"][k, i]) - true.p) <= Fraction(found.bound) < 1e-11
            assert abs(Fraction(found.points["q"][k, i]) - true.q) <= Fraction(found.bound)
    elsewhere = exact_points(DRIVEN, {"p": P, "q": Q}, times[2:])
    assert np.abs(elsewhere.points["p"] - found.points["p"][2:]).max() > 1e-3


def image(scheme: str, steps: int = STEPS, h: Fraction = H) -> FlowImage:
    shape = PlacedShape(shape="circle", centre={"q": 1, "p": 0}, scale=Fraction(1, 4)).to_shape()
    return carry(DRIVEN, scheme, shape, step_size=h, steps=steps, digits=17,
                 mean_lambda=True, distance=True, t0=T0)  # fmt: skip


def test_a_splitting_keeps_area_and_nears_the_flow_by_its_order() -> None:
    coarse, fine = image("stormer-verlet"), image("stormer-verlet", 2 * STEPS, H / 2)
    assert coarse.area_preserving
    assert abs(Fraction(coarse.area_change or 1)) <= Fraction(coarse.probe_error or 0)
    assert 3.8 < float(coarse.distance or 0) / float(fine.distance or 1) < 4.2
    first, second = (
        image("stormer-verlet, clock frozen", n, h) for n, h in ((STEPS, H), (2 * STEPS, H / 2))
    )
    assert first.area_preserving
    assert 1.9 < float(first.distance or 0) / float(second.distance or 1) < 2.1


def test_where_h_opens_on_the_way_its_step_is_named_and_nothing_is_carried() -> None:
    opened = Hamiltonian.parse("p**2/2 + q**2/(2*(1 - t)**2)")
    square = PlacedShape(shape="square").to_shape()
    for name in ("lie2", EXACT_FLOW):
        asked = {"digits": 17, "mean_lambda": False, "distance": False}
        image = carry(opened, name, square, step_size=Fraction(1, 10), steps=20, **asked)
        assert "at step 10, from t = 0.9 on, H is not smooth" in str(image.problem)
        before = carry(opened, name, square, step_size=Fraction(1, 10), steps=5, **asked)
        assert not before.problem
