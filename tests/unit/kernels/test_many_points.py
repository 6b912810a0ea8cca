"""Many points by one step map: the same as one by one in every number system; who leaves it."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from tests.helpers.known_areas import DUFFING, PENDULUM
from verify import arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.many_points import LeftRangeError, PointMap
from verify.runs.requested_run import run

H, N = Fraction(1, 20), 40


def made(hamiltonian: Hamiltonian, scheme: str, name: str = "float64", **more: Any) -> PointMap:
    given = {"step_size": H, "steps": N, **more}
    return PointMap(hamiltonian, scheme, arithmetic=arithmetic.get(name, 25), **given)


def cloud(count: int) -> tuple[np.ndarray, np.ndarray]:
    p, q = np.random.default_rng(4).uniform(-1, 1, (2, count))
    return p, q


@pytest.mark.sample(11)
@pytest.mark.parametrize("scheme", ["lie2", "stormer-verlet", "gauss4"])
@pytest.mark.parametrize("count", [1, 63, 64, 65, 257, 600])
def test_points_in_lanes_have_the_bits_of_runs_one_by_one(scheme: str, count: int) -> None:
    p, q = cloud(count)
    found = made(DUFFING, scheme, observables=frozenset({"lambda"}))(p=p, q=q)
    for i in {0, count // 2, count - 1}:
        point = made(DUFFING, scheme, observables=frozenset({"lambda"}))
        alone = point(p=p[i : i + 1], q=q[i : i + 1])
        assert all(found[name][i] == alone[name][0] for name in ("p", "q", "lam"))
        one = run(DUFFING, scheme, q=Fraction(q[i]), p=Fraction(p[i]), step_size=H, steps=N,
                  arithmetic="float64", digits=17, observables=("lambda",))  # fmt: skip
        value, bound = (Fraction(x) for x in (one.values["q"].value, one.values["q"].bound))
        assert abs(value - Fraction(found["q"][i])) <= 2 * bound < 1e-13


@pytest.mark.parametrize("name", ["fixed", "mpfr", "mpmath"])
def test_number_systems_agree(name: str) -> None:
    p, q = cloud(3)
    floats = made(DUFFING, "lie2")(p=p, q=q)
    system = arithmetic.get(name, 25)
    numbers = [[system.number(Fraction(x)) for x in z] for z in (p, q)]
    found = made(DUFFING, "lie2", name)(p=numbers[0], q=numbers[1])
    for which in ("p", "q"):
        for x, true in zip(floats[which], found[which], strict=True):
            assert abs(Fraction(x) - system.exact(true)) < 1e-14


def test_points_given_are_not_changed() -> None:
    p, q = cloud(5)
    before = p.copy(), q.copy()
    made(PENDULUM, "lie2")(p=p, q=q)
    assert all(map(np.array_equal, (p, q), before))


def test_compensated_sums_are_nearer_to_the_truth() -> None:
    p, q = cloud(40)
    true = made(DUFFING, "lie2", "mpfr", steps=2000)
    system = true.arithmetic
    numbers = [[system.number(Fraction(x)) for x in z] for z in (p, q)]
    exact = [float(system.exact(x)) for x in true(p=numbers[0], q=numbers[1])["q"]]
    plain, better = (
        np.abs(made(DUFFING, "lie2", steps=2000, compensated=c)(p=p, q=q)["q"] - exact).max()
        for c in (False, True)
    )
    assert better < plain / 3


@pytest.mark.parametrize("name", ["float64", "mpfr", "fixed"])
def test_a_point_that_leaves_the_range_is_named(name: str) -> None:
    soft = Hamiltonian.parse("p**2/2 - q**4/4")
    system = arithmetic.get(name, 25)
    p, q = [0, Fraction(1, 4)], [Fraction(1, 10), 3]
    given = [[system.number(Fraction(x)) for x in z] for z in (p, q)]
    with pytest.raises(
        LeftRangeError, match=r"^the point \(q, p\) = \(3, 0\.25\) leaves the range of"
    ):
        made(soft, "lie2", name, steps=100)(p=given[0], q=given[1])


def test_what_is_outside_of_h_is_left_too() -> None:
    root = Hamiltonian.parse("p**2/2 + sqrt(q)")
    one, far, near = np.zeros(1), np.array([50.0]), np.array([50.0, 0.1])
    assert made(root, "lie1")(p=one, q=far)["q"][0] > 49
    with pytest.raises(
        LeftRangeError, match=r"\(q, p\) = \(0\.1, 0\) leaves the range of float64, or"
    ):
        made(root, "lie1")(p=np.zeros(2), q=near)
