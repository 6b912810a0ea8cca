"""Maps that are symplectic, that preserve volume alone, and neither: all judged rightly."""

import math
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import verify
from tests.end_to_end.test_command_line import here, json_of
from verify.errors import InputError
from verify.integrators.results import Finding

COS, SIN = math.cos(0.3), math.sin(0.3)
WEIGHTS = np.array([[0.3, -0.2], [0.5, 0.7]])
SCALES = np.array([0.4, -0.6])
Map = Callable[..., Any]


def henon(p, q):
    return q - p**2 + 0.3, -p


def henon_with_friction(p, q):
    return 0.3 * q + 1 - 1.4 * p**2, p


def standard(p, q, k=0.5):
    p = p + k * math.sin(q)
    return p, q + p


def rotated(p, q):
    return COS * p - SIN * q, SIN * p + COS * q


def rotated_and_damped(p, q):
    return 0.999 * (COS * p - SIN * q), SIN * p + COS * q


def sextupole(p, q):
    p = p - np.array([(q[0] ** 2 - q[1] ** 2) / 2, -q[0] * q[1]])
    return p, q + p


def no_gradient(p, q):
    p = p - np.array([(q[0] ** 2 - q[1] ** 2) / 2, q[0] * q[1]])
    return p, q + p


def scaled(p, q):
    return [p[0] * 2, p[1] / 2], [q[0] / 2, q[1] * 2]


def scaled_wrongly(p, q):
    return [p[0] * 2, p[1] / 2], [q[0], q[1]]


def across(p, q):
    return [p[0] * 2, p[1]], [q[0], q[1] / 2]


def network(p, q):
    p = p + WEIGHTS.T @ (SCALES * np.tanh(WEIGHTS @ q))
    return p, q + WEIGHTS.T @ (SCALES * np.tanh(WEIGHTS @ p))


def network_not_transposed(p, q):
    p = p + WEIGHTS @ (SCALES * np.tanh(WEIGHTS @ q))
    return p, q + WEIGHTS.T @ (SCALES * np.tanh(WEIGHTS @ p))


def three_shears(p, q):
    p = p - q[::-1] * q[1]
    p[1] = p[1] + 0 * q[1]
    return p, q


def exchange(p, q):
    return q, -p


def exchange_without_sign(p, q):
    return q, p


def magnet(z):
    x, px, y, py = z
    px, py = px - (x * x - y * y), py + 2 * x * y
    return np.array([x + px, px, y + py, py])


def magnet_with_an_error(z):
    x, px, y, py = z
    px, py = px - (x * x - y * y), py + 2.001 * x * y
    return np.array([x + px, px, y + py, py])


def solved(p, q, h=0.1):
    p1, q1 = p, q
    for _ in range(50):
        a, b = p - h * math.sin((q + q1) / 2), q + h * (p + p1) / 2
        near = abs(a - p1) + abs(b - q1) < 1e-14
        p1, q1 = a, b
        if near:
            break
    return p1, q1


def solved_wrongly(p, q, h=0.1):
    p1, q1 = p, q
    for _ in range(50):
        a, b = p - h * math.sin(q1), q + h * (p + p1) / 2
        near = abs(a - p1) + abs(b - q1) < 1e-14
        p1, q1 = a, b
        if near:
            break
    return p1, q1


class Hidden:
    """What symbols and dual numbers do not go through."""

    def __init__(self, factor: float) -> None:
        self.factor = np.array([factor])

    def __call__(self, p, q):
        return self.factor.astype(float).item() * p + 0 * memoryview(self.bytes(p))[0], q

    @staticmethod
    def bytes(x):
        return np.array([x], dtype=float).view(np.float64)


def logarithm(p, q):
    return math.log(p), p * q


# (degrees, symplectic, det J ≡ 1, the entry that shows it)
YES, NO = True, False
CASES: dict[Map, tuple[int, bool, bool | None, set[str]]] = {
    henon: (1, YES, YES, {""}),
    henon_with_friction: (1, NO, NO, {"dp∧dq"}),
    standard: (1, YES, YES, {""}),
    rotated: (1, YES, YES, {""}),
    rotated_and_damped: (1, NO, NO, {"dp∧dq"}),
    sextupole: (2, YES, YES, {""}),
    no_gradient: (2, NO, YES, {"dq1∧dq2"}),
    scaled: (2, YES, YES, {""}),
    scaled_wrongly: (2, NO, YES, {"dp1∧dq1", "dp2∧dq2"}),
    across: (2, NO, YES, {"dp1∧dq1", "dp2∧dq2"}),
    network: (2, YES, YES, {""}),
    network_not_transposed: (2, NO, None, {"dq1∧dq2", "dp1∧dp2", "dp1∧dq1"}),
    three_shears: (3, NO, YES, {"dq1∧dq2", "dq2∧dq3", "dq1∧dq3"}),
    exchange: (3, YES, YES, {""}),
    exchange_without_sign: (1, NO, NO, {"dp∧dq"}),
    magnet: (2, YES, YES, {""}),
    magnet_with_an_error: (2, NO, YES, {"dq1∧dq2"}),
    solved: (1, YES, YES, {""}),
    solved_wrongly: (1, NO, NO, {"dp∧dq"}),
    logarithm: (1, YES, YES, {""}),
}


def judged(function: Map) -> Finding:
    order = "q1,p1,q2,p2" if "magnet" in function.__name__ else None
    return verify.check_map(function, CASES[function][0], arguments=order)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("function", CASES, ids=lambda f: f.__name__)
def test_each_is_judged_rightly(function: Map) -> None:
    found = judged(function)
    _, symplectic, volume, entries = CASES[function]
    assert found.symplectic is symplectic, found
    assert found.verdict.holds is symplectic
    assert found.entry in entries
    if volume is not None:
        assert found.area_preserving is volume
    assert (found.counterexample is None) is symplectic


@pytest.mark.parametrize(
    ("function", "how"),
    [(sextupole, "proof"), (rotated, "duals"), (solved, "duals"), (network, "proof")],
)
def test_how_it_is_known(function: Map, how: str) -> None:
    assert judged(function).how == how


@pytest.mark.parametrize("function", [f for f, case in CASES.items() if not case[1]],
                         ids=lambda f: f.__name__)  # fmt: skip
def test_a_counterexample_is_one_for_floats_too(function: Map) -> None:
    """By central differences of the function itself, with nothing of the toolkit."""
    found = judged(function)
    assert found.counterexample is not None
    z = np.array([float(x) for x in found.counterexample.z.values()])
    n = len(z) // 2

    def step(at: np.ndarray) -> np.ndarray:
        if "magnet" in function.__name__:
            back = function(at[[2, 0, 3, 1]])
            return back[[1, 3, 0, 2]]
        p, q = (at[:1], at[1:]) if n == 1 else (at[:n].copy(), at[n:].copy())
        pair = function(p[0], q[0]) if n == 1 else function(p, q)
        return np.concatenate([np.ravel(x) for x in pair])

    jacobian = np.empty((2 * n, 2 * n))
    for k in range(2 * n):
        unit = np.zeros(2 * n)
        unit[k] = 1e-5
        jacobian[:, k] = (step(z + unit) - step(z - unit)) / 2e-5
    omega = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    defect = jacobian.T @ omega @ jacobian - omega
    names = list(found.counterexample.z)
    a, b = (names.index(x[1:]) for x in found.entry.split("∧"))
    said = float(found.counterexample.found.strip("[]").split()[0])
    assert defect[a, b] == pytest.approx(said, abs=1e-6)
    assert abs(said) > 1e-5


def test_what_only_floats_go_through_is_measured() -> None:
    right, wrong = verify.check_map(Hidden(1.0)), verify.check_map(Hidden(1.01))
    assert (right.verdict, right.how) == ("MEASURED", "floats")
    assert (wrong.verdict, wrong.how, wrong.entry) == ("REFUTED", "floats", "dp∧dq")
    assert right.probe_error is not None
    assert right.probe_error < 1e-8


def on_the_torus(p, q, factor=1.0):
    p, q = standard(p, q, 0.9)
    return factor * p % (2 * math.pi), q % (2 * math.pi)


def test_points_at_which_the_map_wraps_are_left_out_and_named() -> None:
    found = verify.check_map(on_the_torus, point=[0, 0])
    assert (found.verdict, found.area_preserving) == ("MEASURED", True), found.reason
    assert found.probe_error is not None
    assert found.probe_error < 1e-8
    (note,) = [x for x in found.notes if "left out" in x]
    assert "p = 0, q = 0 (" in note


@pytest.mark.parametrize(
    ("factor", "verdict"),
    [(1 + 3e-5, "REFUTED"), (0.5, "REFUTED"), (1 + 3e-10, "REFUTED"), (1 + 1e-16, "MEASURED")],
)
def test_an_error_shows_at_the_other_points(factor: float, verdict: str) -> None:
    found = verify.check_map(lambda p, q: on_the_torus(p, q, factor))
    assert found.verdict == verdict, found.reason
    if verdict == "REFUTED":
        assert found.largest == pytest.approx(abs(factor - 1), rel=1e-2)


def test_a_map_that_wraps_at_every_point_is_undecided() -> None:
    found = verify.check_map(lambda p, q: (p % 1e-3, q))
    assert found.verdict == "UNDECIDED"
    assert any("the probe sees nothing" in note for note in found.notes)


def test_a_matrix_is_judged_as_it_stands_and_within_what_is_allowed() -> None:
    def turned(p, q):
        return 0.955336489126 * p - 0.295520206661 * q, 0.295520206661 * p + 0.955336489126 * q

    found = verify.check_map(turned)
    assert (found.verdict, found.symplectic) == ("REFUTED", False)
    assert any("within half a unit of the 12th digit" in str(note) for note in found.notes)
    assert verify.check_map(turned, within="1e-11").verdict == "MEASURED"


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"degrees": 0}, "must be 1 … 64"),
        ({"degrees": 2, "arguments": "q,x2"}, "is no order of p1, p2, q1, q2"),
        ({"parameters": {"k": 1}}, "is no argument of"),
        ({"point": [1]}, "has 1 numbers; allowed: 2"),
    ],
)
def test_bad_input_is_one_line(given: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        verify.check_map(lambda p, q: (p, q), **given)
    with pytest.raises(InputError, match="wanted: map"):
        verify.check_map(lambda p, q, r: (p, q))


def test_a_point_of_ones_own_is_looked_at() -> None:
    def there_only(p, q):
        return (2 * p if 9 < p < 11 else p), q

    found = verify.check_map(there_only, point=[10, 0])
    assert found.symplectic is False
    assert found.counterexample is not None
    assert found.counterexample.z == {"p": Fraction(10), "q": Fraction(0)}
    assert verify.check_map(there_only).symplectic is False  # what it compares is solved for


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "def kick(p, q, k):\n    return [p[0] - k*q[1], p[1] - q[0]], q\n"
        "def turn(z):\n    return [-z[1], z[0]]\n"
    )
    typed = ("check-map", f"{file}:kick", "--degrees", "2", "--json")
    status, out, _ = here(capsys, *typed, "--param", "k=1")
    assert (status, json_of(out)["verdict"]) == (0, "PROVED")
    status, out, _ = here(capsys, *typed, "--param", "k=1.5")
    found = json_of(out)
    assert (status, found["verdict"], found["symplectic"]) == (1, "REFUTED", False)
    assert found["area_preserving"] is True
    assert found["counterexample"]["entry"] == "dq1∧dq2"
    assert float(found["counterexample"]["found"].strip("[]").split()[0]) == 0.5
    status, out, _ = here(capsys, "check-map", f"{file}:turn", "--arguments", "q,p")
    assert (status, out.startswith("PROVED")) == (0, True)
    file.write_text("def raises(p, q):\n    raise ValueError('no')\n")
    status, out, err = here(capsys, "check-map", f"{file}:raises")
    assert (status, out, "raises ValueError: no" in err) == (2, "", True)
    file.write_text("def kick(p, q, k):\n    return [p[0] - k*q[1], p[1] - q[0]], q\n")
    for wrong in (("--q", "1"), ("--p", "1,2,3", "--q", "1,2"), ("--param", "k")):
        status, out, err = here(capsys, *typed, *wrong)
        assert (status, err.count("\n")) == (2, 1)


def test_of_a_map_that_is_measured_no_step_size_is_told() -> None:
    """And of a step both are: the sentence's twin."""

    def turned(p, q):
        return (p, q) if q > 1e9 else rotated(p, q)

    def euler(p, q, h):
        return (p, q) if q > 1e9 else (p - h * q, q + h * (p - h * q))

    noise = "within the noise of doubles"
    assert re.fullmatch(
        rf"\|ΔJ\| ≤ \S+ at every place, {noise}", str(verify.check_map(turned).reason)
    )
    assert f" at every place and step size, {noise}" in found_of(euler).reason


def found_of(step: Map) -> Finding:
    found = verify.check("p**2/2 + q**2/2", step)
    assert isinstance(found, Finding)
    return found


def shrinking(p: float, q: float) -> tuple[float, float]:
    """det J is 1 − 3e-14; the branch keeps it from being proved."""
    a = 0.0 if q > 1e9 else p - 0.5 * math.sin(q)
    return a * (1 - 3e-14), q + 0.5 * a


@pytest.mark.parametrize(
    ("within", "verdict"), [("4e-14", "MEASURED"), ("2.4e-14", "UNDECIDED"), ("1.5e-14", "REFUTED")]
)
def test_a_defect_beyond_what_is_allowed_is_not_within_it(within: str, verdict: str) -> None:
    found = verify.check_map(shrinking, within=within)
    assert found.verdict == verdict
    assert "det J is 1 all the same" not in str(found), "in the plane S is det J − 1"
