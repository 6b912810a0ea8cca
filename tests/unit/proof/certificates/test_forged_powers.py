"""Forgeries in the powers of h alone: what stands beyond those that somebody may look at."""

import copy
from typing import Any

import pytest

from verify.proof.certificates.checker import check

Data = dict[str, Any]
POWERS = [(a, b) for a in range(1, 5) for b in range(1, 5)]
EVERY, PLANE, SEVERAL, TIMED = "every H", "the plane", "two degrees", "in time"
KINDS = [EVERY, PLANE, SEVERAL, TIMED]


def series(name: str, power: int, change: list[list[str]], length: int) -> list[Any]:
    """name + change · h^power, of so many coefficients."""
    found: list[Any] = [[] for _ in range(length)]
    found[0] = [["1", name]]
    found[power] = change
    return found


def preserving(kind: str, a: int, b: int, square: bool = True) -> Data:
    """A certificate that says det J = 1, or S = 0, of p' = p + h^a q², q' = q + h^b p², of which
    det J = 1 − 4 p q h^(a + b); or, where there is no `square`, of q' = q."""
    p, q = ("p1", "q1") if kind == SEVERAL else ("p", "q")
    length = max(a, b) + 1
    after = {
        p: series(p, a, [["1", q, q]], length),
        q: series(q, b, [["1", p, p]] if square else [], length),
    }
    data: Data = {
        "format": "areaproof certificate 2", "hamiltonian": [["1/2", p, p]], "parameters": [],
        "functions": [], "order": None, "convergence_order": 0, "leading": [], "cofactors": {},
        "witness": {},
    }  # fmt: skip
    if kind == EVERY:
        for name in ("parameters", "functions", "cofactors", "witness"):
            del data[name]
        data |= {"hamiltonian": "every", "separable": False}
    if kind == TIMED:
        data["time_dependent"] = True
    if kind == SEVERAL:
        beside = {n: series(n, 1, [], length) for n in ("p2", "q2")}
        return data | {"degrees": 2, "next": after | beside}
    return data | {"p_next": after["p"], "q_next": after["q"]}


@pytest.mark.parametrize(("a", "b"), POWERS)
@pytest.mark.parametrize("kind", KINDS)
def test_a_defect_in_the_highest_powers_of_h_is_seen(kind: str, a: int, b: int) -> None:
    """A map of n coefficients has a Jacobian determinant of up to h^(2n − 2)."""
    with pytest.raises(ValueError, match=f"^(det|S) {a + b}( p1 q1)? is not zero"):
        check(preserving(kind, a, b))
    check(preserving(kind, a, b, square=False))  # a shear, which is what it says


def of_order_2(kind: str, extra: int = 0, at: str = "") -> Data:
    """Explicit Euler's certificate for H = p²/2 + q⁴; to the series of `at` so many coefficients
    are appended, of which nothing is proved."""
    p, q = ("p1", "q1") if kind == SEVERAL else ("p", "q")
    after = {p: [[["1", p]], [["-4", q, q, q]]], q: [[["1", q]], [["1", p]]]}
    data: Data = {
        "format": "areaproof certificate 2",
        "hamiltonian": [["1/2", p, p], ["1", q, q, q, q]], "parameters": [], "functions": [],
        "order": 2, "convergence_order": 1, "leading": [["12", q, q]], "cofactors": {},
        "witness": {p: "7/17", q: "7/17"},
    }  # fmt: skip
    if kind == TIMED:
        data |= {"time_dependent": True, "witness": data["witness"] | {"t": "1"}}
    if kind == SEVERAL:
        after |= {"p2": [[["1", "p2"]]], "q2": [[["1", "q2"]], [["1", "p2"]]]}
        data["hamiltonian"].append(["1/2", "p2", "p2"])
        data |= {"degrees": 2, "leading": [["p1", "q1", [["12", "q1", "q1"]]]]}
        data["witness"] |= {"p2": "1", "q2": "1"}
    if extra:
        longest = max(map(len, after.values()))
        after[at] = after[at] + [[]] * (longest - len(after[at]) + 1) + [[["7", q]]] * extra
    if kind == SEVERAL:
        return data | {"next": after}
    return data | {"p_next": after["p"], "q_next": after["q"]}


@pytest.mark.parametrize("extra", [1, 2, 5])
@pytest.mark.parametrize("at", ["first", "last"])
@pytest.mark.parametrize("kind", [PLANE, SEVERAL, TIMED])
def test_a_series_longer_than_is_said_of_it_is_refused(kind: str, at: str, extra: int) -> None:
    """Coefficients that nothing is proved of would be printed beside those that are."""
    check(of_order_2(kind))
    coordinates = ("p1", "q2") if kind == SEVERAL else ("p", "q")
    long = of_order_2(kind, extra, coordinates[0 if at == "first" else 1])
    with pytest.raises(ValueError, match="are longer than is said of them"):
        check(long)


def test_a_coefficient_beyond_the_order_is_refused_of_every_h_as_well() -> None:
    data: Data = {
        "format": "areaproof certificate 2", "hamiltonian": "every", "separable": False,
        "order": 2, "convergence_order": 1,
        "leading": [["1", "H_pp", "H_qq"], ["-1", "H_pq", "H_pq"]],
        "p_next": [[["1", "p"]], [["-1", "H_q"]]], "q_next": [[["1", "q"]], [["1", "H_p"]]],
    }  # fmt: skip
    check(data)
    long = copy.deepcopy(data)
    long["q_next"] += [[], [["1", "H_p"]]]
    with pytest.raises(ValueError, match="are longer than is said of them"):
        check(long)
