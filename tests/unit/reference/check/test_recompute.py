"""What is computed again agrees with what was made, and a planted error anywhere is found."""

import random
from collections.abc import Iterator
from typing import Any

import pytest

from tests.helpers.constructed.reference import SCENES, changed, made
from verify.reference.check.difference import DataFindings, Difference
from verify.reference.check.recompute import recompute_unit
from verify.reference.make.models import Data

KINDS = {"proof": "proofs", "run": "runs", "flow": "flow"}
_SCHEMES = '["lie3", "lie4", "yoshida4", "position-verlet", "explicit-midpoint", "euler"]'
OTHERS = {
    "other": f"""
hamiltonian = "sqrt(1 + p**2) + log(1 + q**2) + a*q**6"
parameters = {{ a = "1/7" }}
schemes = {_SCHEMES}
[[reference]]
step_sizes = ["1/8"]
initial_values = [{{ q = "0.7", p = "0.4" }}]
steps = [1, 12]
digits = 20
""",
    "driven": """
hamiltonian = "p**2/2 + a*q**4 + p**2/(4*(2 + sin(t))) - q*cos(3*t)*exp(-t**2/9)"
parameters = { a = "1/7" }
t0 = "2/3"
schemes = ["lie2", "lie3", "yoshida4", "position-verlet", "symplectic-euler", "rk4"]
[[reference]]
step_sizes = ["1/8"]
initial_values = [{ q = "0", p = "0" }, { q = "0.7", p = "0.4" }]
steps = [0, 1, 12]
digits = 20
""",
    "not-separable": """
hamiltonian = "p**2/2 + q**2/2 + p**2*q/4 + exp(p*q/3)"
schemes = ["lie3", "rk4", "explicit-midpoint"]
[[reference]]
step_sizes = ["1/8"]
initial_values = [{ q = "0.3", p = "0.4" }]
steps = [1, 12]
""",
}


def data(name: str) -> Data:
    return made({name: (SCENES | OTHERS)[name]})[0]


def units(of: Data) -> Iterator[tuple[str, int]]:
    for kind, field in KINDS.items():
        yield from ((kind, k) for k in range(len(getattr(of, field))))


def again(of: Data, kind: str, index: int) -> DataFindings:
    return recompute_unit(of, "file", kind, index)


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["mine", "leaves", "other", "not-separable", "driven"])
def test_all_that_is_made_is_found_again(name: str) -> None:
    rows = 0
    for kind, index in units(data(name)):
        found = again(data(name), kind, index)
        assert not found.differences, found.differences[0]
        assert not found.not_recomputed
        rows += found.recomputed
    left = [x for run in data(name).runs for x in run.rows if x.status == "left range"]
    assert rows == data(name).count
    assert bool(left) is (name == "leaves")


@pytest.mark.parametrize(
    ("formula", "q", "p"), [("p + 2*q", "0.3", "0.4"), ("p1 + 2*q2", '["0.3", 1]', '["0.4", 0]')]
)
def test_a_linear_h_whose_jacobians_are_whole_numbers_is_found_again(
    formula: str, q: str, p: str
) -> None:
    toml = f"""
hamiltonian = "{formula}"
schemes = ["lie1", "rk4", "stormer-verlet"]
[[reference]]
step_sizes = ["1/8"]
initial_values = [{{ q = {q}, p = {p} }}]
steps = [0, 1, 12]
"""
    of = made({"linear": toml})[0]
    findings = [again(of, kind, index) for kind, index in units(of)]
    assert not any(each.differences or each.not_recomputed for each in findings)
    assert sum(each.recomputed for each in findings) == of.count


def cells(of: Data, kind: str) -> Iterator[list[Any]]:
    """The places of all printed numbers that are not 0."""
    raw = of.model_dump(mode="json", by_alias=True)
    for k, item in enumerate(raw[KINDS[kind]]):
        for j, row in enumerate(item["rows"]):
            for name, cell in row.items():
                if isinstance(cell, dict) and cell["value"] != "0":
                    yield [KINDS[kind], k, "rows", j, name]


@pytest.mark.left_to_ci
@pytest.mark.parametrize("kind", ["run", "flow"])
def test_any_other_digit_of_any_number_is_found(kind: str) -> None:
    draw, of = random.Random(5), data("mine")  # noqa: S311 - no secret
    for place in cells(of, kind):
        cell = of.model_dump(mode="json", by_alias=True)
        for part in place:
            cell = cell[part]
        text = cell["value"]
        mantissa = text.partition("e")[0]
        spots = [k for k, c in enumerate(mantissa) if c.isdigit()]
        at = draw.choice([*spots, spots[-1]])
        other = draw.choice([c for c in "123456789" if c != text[at]])
        wrong = changed(of, [*place, "value"], text[:at] + other + text[at + 1 :])
        found = again(wrong, kind, place[1])
        assert [x.column for x in found.differences] == [place[-1]], (place, text, at, other)


@pytest.mark.parametrize(
    ("path", "value", "column"),
    [
        (["runs", 2, "scheme"], "lie3", "q"),
        (["runs", 2, "step_size"], "0.100001", "q"),
        (["runs", 2, "q"], "1.500001", "q"),
        (["parameters", "a"], "1.500001", "p"),
        (["hamiltonian"], "p**2/2 - a*sin(q)", "p"),
    ],
)
def test_another_input_gives_other_numbers(path: list[Any], value: str, column: str) -> None:
    found = again(changed(data("mine"), path, value), "run", 2)
    assert column in {x.column for x in found.differences}


@pytest.mark.parametrize("kind", ["run", "flow"])
def test_another_time_at_the_start_gives_other_numbers(kind: str) -> None:
    of = data("driven")
    assert of.timed
    items = getattr(of, KINDS[kind])
    for k in range(len(items)):
        found = again(changed(of, [KINDS[kind], k, "t0"], "0.6666"), kind, k)
        assert {"p", "q"} <= {x.column for x in found.differences}


def test_an_h_without_t_has_no_t0() -> None:
    raw = data("mine").model_dump(mode="json", by_alias=True)
    assert not data("mine").timed
    assert all("t0" not in x for x in (*raw["runs"], *raw["flow"]))


@pytest.mark.parametrize(
    ("scheme", "field", "value"),
    [
        (0, "order", 1),
        (0, "order", 3),
        (1, "leading", "-3*p*sin(q)/4 + p"),
        (1, "leading", "0"),
        (1, "convergence_order", 1),
        (1, "convergence_order", 3),
        (1, "order", 4),
        (1, "order", 10**9),
        (2, "order", 5),
        (2, "convergence_order", 10**9),
        (3, "convergence_order", 1),
        (3, "convergence_order", None),
        (3, "order", 3),
    ],
)
def test_a_wrong_order_or_coefficient_is_found(scheme: int, field: str, value: Any) -> None:
    found = again(changed(data("mine"), ["proofs", scheme, field], value), "proof", scheme)
    columns = {x.column for x in found.differences}
    assert columns <= {"order", "leading", "convergence_order"}
    assert columns


def test_an_area_that_is_said_to_be_preserved_and_is_not_is_found() -> None:
    of = data("mine")
    of = changed(of, ["proofs", 1, "area_preserving"], True)
    of = changed(of, ["proofs", 1, "order"], None)
    found = again(changed(of, ["proofs", 1, "leading"], "0"), "proof", 1)
    assert found.differences[0].column == "order"


@pytest.mark.parametrize("step", [-1, 1])
def test_the_step_that_left_the_range_is_found_again(step: int) -> None:
    of = data("leaves")
    place = next(
        ["runs", k, "rows", j, "failed_step"]
        for k, run in enumerate(of.runs)
        for j, row in enumerate(run.rows)
        if row.failed_step
    )
    row = of.runs[place[1]].rows[place[3]]
    assert row.failed_step is not None
    found = again(changed(of, place, row.failed_step + step), "run", place[1])
    assert found.differences


def test_an_orbit_that_is_not_defined_any_more_has_left() -> None:
    toml = """
hamiltonian = "p**2/2 + q*log(q) - q"
schemes = ["lie2"]
[[reference]]
step_sizes = [1]
initial_values = [{ q = "0.5", p = "-2" }]
steps = [0, 1, 3, 5]
digits = 8
flow = false
"""
    of = made({"pole": toml})[0]
    statuses = [row.status for row in of.runs[0].rows]
    assert statuses[0] == "finished"
    assert "left range" in statuses
    found = again(of, "run", 0)
    assert (found.differences, found.not_recomputed, found.recomputed) == ([], [], 4)


def test_an_orbit_that_is_said_to_leave_and_does_not_is_found() -> None:
    of = data("mine")
    nothing = dict.fromkeys(("kind", "p", "q", "delta_j", "mse", "lambda"))
    row = {"step": 30, "status": "left range", "failed_step": 12, **nothing}
    found = again(changed(of, ["runs", 1, "rows", 3], row), "run", 1)
    assert isinstance(found.differences[0], Difference)
    assert found.differences[0].column == "status"


def test_a_scheme_that_is_not_known_here_is_named() -> None:
    toml = OTHERS["other"].replace(_SCHEMES, '["ruth3"]')
    of = made({"unknown": toml})[0]
    for kind in ("run", "proof"):
        found = again(of, kind, 0)
        assert "ruth3" in found.not_recomputed[0]
        assert found.recomputed == 0
