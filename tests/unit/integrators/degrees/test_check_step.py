"""Steps of arrays for an H of several degrees of freedom: right ones and wrong ones."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.end_to_end.test_command_line import here, json_of
from tests.helpers.programs.judged import judged
from verify.errors import InputError
from verify.integrators.results import Claims, Finding

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
DRIVEN = f"{HENON} - q1*cos(t)"
KEPLER = "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"
ROTATING = "(p1**2 + p2**2)/2 + p1*q2 - p2*q1 + q1**2*q2"  # not separable
W1 = 1 / (2 - 2 ** (1 / 3))
ROOTS = "(p1**2 + p2**2)/2 + sqrt(q1 - 5) + q2"
NOWHERE = f"{ROOTS} + sqrt(4 - q1)"
Step = Callable[..., Any]


def force(q):
    return -np.array([q[0] + 2 * q[0] * q[1], q[1] + q[0] ** 2 - q[1] ** 2])


def verlet(p, q, h):
    p = p + h / 2 * force(q)
    q = q + h * p
    return p + h / 2 * force(q), q


def euler(p, q, h):
    return p + h * force(q), q + h * p


def rk4(p, q, h):
    k1, v1 = force(q), p
    k2, v2 = force(q + h / 2 * v1), p + h / 2 * k1
    k3, v3 = force(q + h / 2 * v2), p + h / 2 * k2
    k4, v4 = force(q + h * v3), p + h * k3
    return p + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), q + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)


def yoshida(p, q, h):
    for w in (W1, 1 - 2 * W1, W1):
        p, q = verlet(p, q, w * h)
    return p, q


def wrong_weights(p, q, h):
    for w in (W1, 2 * W1 - 1, W1):
        p, q = verlet(p, q, w * h)
    return p, q


def no_potential(p, q, h):
    """The sign of one term of the force is wrong: it is no gradient any more."""

    def wrong(q):
        return -np.array([q[0] + 2 * q[0] * q[1], q[1] - q[0] ** 2 - q[1] ** 2])

    p = p + h / 2 * wrong(q)
    q = q + h * p
    return p + h / 2 * wrong(q), q


def skewed(p, q, h):
    p, q = verlet(p, q, h)
    return p + h**3 * np.array([q[1], 0 * q[0]]), q


def one_exchanged(p, q, h):
    """The components of the last kick are exchanged."""
    p = p + h / 2 * force(q)
    q = q + h * p
    return p + h / 2 * force(q)[::-1], q


def verlet_of_roots(p, q, h):
    def pull(q):
        return -np.array([1 / (2 * math.sqrt(q[0] - 5)), 1])

    p = p + h / 2 * pull(q)
    q = q + h * p
    return p + h / 2 * pull(q), q


def q_first(x, v, dt):
    v, x = verlet(v, x, dt)
    return x, v


def midpoint(p, q, h):
    p1, q1 = p, q
    for _ in range(60):
        a, b = p + h * force((q + q1) / 2), q + h * (p + p1) / 2
        near = max(abs(a - p1)) + max(abs(b - q1)) < 1e-15
        p1, q1 = a, b
        if near:
            break
    return p1, q1


def trapezoid(p, q, h):
    """Solved by a loop, and not symplectic."""
    p1, q1 = p, q
    for _ in range(60):
        a, b = p + h / 2 * (force(q) + force(q1)), q + h * (p + p1) / 2
        near = max(abs(a - p1)) + max(abs(b - q1)) < 1e-15
        p1, q1 = a, b
        if near:
            break
    return p1, q1


def kepler(p, q, h):
    def pull(q):
        return -q / np.sqrt(q @ q) ** 3

    p = p + h / 2 * pull(q)
    q = q + h * p
    return p + h / 2 * pull(q), q


def rotating(p, q, h):
    """Explicit midpoint."""

    def slope(p, q):
        f = np.array([p[1] - 2 * q[0] * q[1], -p[0] - q[0] ** 2])
        return f, np.array([p[0] + q[1], p[1] - q[0]])

    f, v = slope(p, q)
    f, v = slope(p + h / 2 * f, q + h / 2 * v)
    return p + h * f, q + h * v


def driven(p, q, t, h):
    def pushed(q, t):
        return force(q) + np.array([math.cos(t), 0])

    p = p + h / 2 * pushed(q, t)
    q = q + h * p
    return p + h / 2 * pushed(q, t + h), q


def driven_by_a_still_clock(p, q, t, h):
    def pushed(q):
        return force(q) + np.array([math.cos(t), 0])

    p = p + h / 2 * pushed(q)
    q = q + h * p
    return p + h / 2 * pushed(q), q


def checked(step: Step, formula: str = HENON, **claims: Any) -> Finding:
    return judged(step, Claims(**claims), hamiltonian=formula)


# H, order of the map, symplectic, det J ≡ 1, order of S
PROVED: dict[Step, tuple[str, int, bool, bool, int | None]] = {
    verlet: (HENON, 2, True, True, None),
    euler: (HENON, 1, False, False, 2),
    rk4: (HENON, 4, False, False, 5),
    skewed: (HENON, 2, False, True, 3),
    q_first: (HENON, 2, True, True, None),
    kepler: (KEPLER, 2, True, True, None),
    rotating: (ROTATING, 2, False, False, 3),
    driven: (DRIVEN, 2, True, True, None),
    driven_by_a_still_clock: (DRIVEN, 1, True, True, None),
}


@pytest.mark.parametrize("step", PROVED, ids=lambda f: f.__name__)
def test_what_symbols_go_through_is_proved(step: Step) -> None:
    formula, order, symplectic, volume, power = PROVED[step]
    found = checked(step, formula)
    assert (found.verdict, found.how, found.convergence_order) == ("PROVED", "proof", order)
    assert (found.symplectic, found.area_preserving) == (symplectic, volume)
    assert found.proof is not None
    assert found.proof.order == power


@pytest.mark.parametrize("step", [no_potential, one_exchanged], ids=lambda f: f.__name__)
def test_what_is_no_scheme_is_refuted(step: Step) -> None:
    found = checked(step)
    assert (found.verdict, found.convergence_order) == ("REFUTED", 0)
    assert "not a scheme for this H" in str(found.reason)


def test_rounded_coefficients_keep_the_order_that_they_are_meant_for() -> None:
    right = checked(yoshida, order=4, symplectic=True)
    assert (right.verdict, right.convergence_order, right.symplectic) == ("MEASURED", 4, True)
    wrong = checked(wrong_weights, order=4)
    assert (wrong.verdict, wrong.convergence_order) == ("REFUTED", 0)


@pytest.mark.left_to_ci
def test_what_compares_numbers_is_measured() -> None:
    right, wrong = checked(midpoint, order=2, symplectic=True), checked(trapezoid)
    assert (right.verdict, right.how, right.symplectic) == ("MEASURED", "duals", True)
    assert (wrong.verdict, wrong.how, wrong.symplectic) == ("MEASURED", "duals", False)
    assert (right.order_decided, right.convergence_order, wrong.convergence_order) == (True, 2, 2)
    assert checked(trapezoid, symplectic=True).verdict == "REFUTED"
    assert checked(midpoint, order=3).verdict == "REFUTED"


CLAIMS: list[tuple[Step, dict[str, Any], str, str]] = [
    (verlet, {"order": 2, "symplectic": True, "area_preserving": True}, "PROVED", ""),
    (verlet, {"order": 3}, "REFUTED", "order 3 is claimed; the map agrees with the exact flow up"),
    (rk4, {"symplectic": True}, "REFUTED", "that it is symplectic is claimed; S has order 5"),
    (rk4, {"area_order": 6}, "PROVED", ""),
    (rk4, {"area_order": 7}, "REFUTED", "is claimed; det J − 1 has order 6"),
    (skewed, {"area_preserving": True}, "PROVED", ""),
    (skewed, {"symplectic": True}, "REFUTED", "S has order 3"),
]


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("step", "claims", "verdict", "words"), CLAIMS)
def test_claims(step: Step, claims: dict[str, Any], verdict: str, words: str) -> None:
    found = checked(step, **claims)
    assert found.verdict == verdict
    assert words in str(found.reason)


def taking_lists(p, q, h):
    """It asks of q what lists alone answer."""
    if not q:
        return p, q
    p, q = verlet(np.array(p), np.array(q), h)
    return list(p), list(q)


@pytest.mark.parametrize(
    ("step", "formula", "words"),
    [
        (verlet_of_roots, NOWHERE, "H has no exact solution from any of the places"),
    ],
)
def test_what_fails_for_no_fault_of_its_own_is_undecided(
    step: Step, formula: str, words: str
) -> None:
    found = judged(step, Claims(order=2), 0.5, formula)
    assert (found.verdict, words in str(found.reason)) == ("UNDECIDED", True), found.reason


def test_lists_and_places_where_h_is_defined_are_found() -> None:
    assert judged(taking_lists, Claims(order=2, symplectic=True), hamiltonian=HENON).verdict.holds
    assert judged(verlet_of_roots, Claims(order=2), hamiltonian=ROOTS).verdict.holds


def test_a_parameter_needs_its_value() -> None:
    with pytest.raises(InputError, match="has no value"):
        checked(verlet, "(p1**2 + p2**2)/2 + k*q1**2*q2")


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "def step(p, q, h):\n"
        "    return [p[0] - h*q[0], p[1] - h*q[1]], [q[0] + h*p[0], q[1] + h*p[1]]\n"
    )
    typed = (
        "check-integrator",
        f"{file}:step",
        "--hamiltonian",
        "(p1**2 + p2**2 + q1**2 + q2**2)/2",
    )
    status, out, _ = here(capsys, *typed, "--json")
    found = json_of(out)
    assert (status, found["verdict"], found["symplectic"], found["order"]) == (
        0,
        "PROVED",
        False,
        2,
    )
    assert (found["degrees"], found["convergence_order"], found["how"]) == (2, 1, "proof")
    assert found["leading"] == "dp1∧dq1 + dp2∧dq2"
    status, out, _ = here(capsys, *typed, "--symplectic")
    assert (status, "REFUTED: that it is symplectic is claimed" in out) == (1, True)
    for wrong in (("--q", "1", "--p", "1"), ("--q", "1,2"), ("--scale", "q=0"), ("--within", "-1"),
                  ("--scale", "r=1"), ("--step-size", "0")):  # fmt: skip
        status, _, err = here(capsys, *typed, *wrong)
        assert (status, err.count("\n")) == (2, 1)
    status, out, _ = here(capsys, *typed, "--q", "1,0", "--p", "0,1", "--step-size", "0.01")
    assert status == 0
    plane = ("check-integrator", f"{file}:flat", "--system", "harmonic", "--param", "omega=1")
    file.write_text("def flat(p, q, h):\n    return p - h*q, q + h*p\n")
    assert here(capsys, *plane, "--symplectic")[0] == 1
    assert here(capsys, *plane)[0] == 0
