"""What is computed again agrees with what was made, and a planted error anywhere is found."""

import random
from collections.abc import Iterator
from typing import Any

import pytest

from tests.helpers.constructed.reference import IN_DEGREES, POLES, SCENES, changed, made
from verify.reference.check.difference import DataFindings, FileDifference
from verify.reference.check.recomputation import recompute_unit
from verify.reference.make.models import AnyData

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


def data(name: str) -> AnyData:
    return made({name: (SCENES | IN_DEGREES | POLES | OTHERS)[name]})[0]


def units(of: AnyData) -> Iterator[tuple[str, int]]:
    for kind, field in KINDS.items():
        yield from ((kind, k) for k in range(len(getattr(of, field))))


def again(of: AnyData, kind: str, index: int) -> DataFindings:
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


def cells(of: AnyData, kind: str) -> Iterator[tuple[list[Any], str]]:
    """The places of all printed numbers that are not 0, and the columns that they are in."""
    raw = of.model_dump(mode="json", by_alias=True)
    for k, item in enumerate(raw[KINDS[kind]]):
        for j, row in enumerate(item["rows"]):
            numbers = [([name], name, x) for name, x in row.items() if isinstance(x, dict)]
            for name in ("p", "q"):
                entries = enumerate(row[name] if isinstance(row[name], list) else ())
                numbers += [([name, i], f"{name}{i + 1}", x) for i, x in entries]
            for place, column, cell in numbers:
                if cell["value"] != "0":
                    yield [KINDS[kind], k, "rows", j, *place], column


@pytest.mark.left_to_ci
@pytest.mark.parametrize("kind", ["run", "flow"])
@pytest.mark.parametrize("name", ["mine", "heiles"])
def test_any_other_digit_of_any_number_is_found(name: str, kind: str) -> None:
    draw, of = random.Random(5), data(name)  # noqa: S311 - no secret
    for place, column in cells(of, kind):
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
        assert [x.column for x in found.differences] == [column], (place, text, at, other)


@pytest.mark.parametrize(
    ("name", "path", "value", "column"),
    [
        ("mine", ["runs", 2, "scheme"], "lie3", "q"),
        ("mine", ["runs", 2, "step_size"], "0.100001", "q"),
        ("mine", ["runs", 2, "q"], "1.500001", "q"),
        ("mine", ["parameters", "a"], "1.500001", "p"),
        ("mine", ["hamiltonian"], "p**2/2 - a*sin(q)", "p"),
        ("heiles", ["runs", 2, "q"], ["0.3", "0.2"], "q2"),
    ],
)
def test_another_input_gives_other_numbers(
    name: str, path: list[Any], value: Any, column: str
) -> None:
    found = again(changed(data(name), path, value), "run", 2)
    assert column in {x.column for x in found.differences}


@pytest.mark.parametrize("kind", ["run", "flow"])
def test_another_time_at_the_start_gives_other_numbers(kind: str) -> None:
    of = data("driven")
    assert of.time_dependent
    items = getattr(of, KINDS[kind])
    for k in range(len(items)):
        found = again(changed(of, [KINDS[kind], k, "t0"], "0.6666"), kind, k)
        assert {"p", "q"} <= {x.column for x in found.differences}


def test_an_h_without_t_has_no_t0() -> None:
    raw = data("mine").model_dump(mode="json", by_alias=True)
    assert not data("mine").time_dependent
    assert all("t0" not in x for x in (*raw["runs"], *raw["flow"]))


LEADING = {"dp1∧dq1": "p2", "dp1∧dq2": "p1", "dp2∧dq1": "p1", "dp2∧dq2": "-p2"}  # by hand


@pytest.mark.parametrize(
    ("name", "scheme", "field", "value"),
    [
        ("mine", 0, "order", 1),
        ("mine", 0, "order", 3),
        ("mine", 1, "leading", "-3*p*sin(q)/4 + p"),
        ("mine", 1, "leading", "0"),
        ("mine", 1, "convergence_order", 1),
        ("mine", 1, "convergence_order", 3),
        ("mine", 1, "order", 4),
        ("mine", 1, "order", 10**9),
        ("mine", 2, "order", 5),
        ("mine", 2, "convergence_order", 10**9),
        ("mine", 3, "convergence_order", 1),
        ("mine", 3, "convergence_order", None),
        ("mine", 3, "order", 3),
        ("heiles", 1, "order", 2),
        ("heiles", 1, "leading", LEADING | {"dp1∧dq1": "2*p2"}),
        ("heiles", 1, "leading", {name: x for name, x in LEADING.items() if name != "dp1∧dq2"}),
        ("heiles", 2, "convergence_order", 3),
    ],
)
def test_a_wrong_order_or_coefficient_is_found(
    name: str, scheme: int, field: str, value: Any
) -> None:
    found = again(changed(data(name), ["proofs", scheme, field], value), "proof", scheme)
    columns = {x.column.partition(" ")[0] for x in found.differences}
    assert columns <= {"order", "leading", "convergence_order"}
    assert columns


def test_the_leading_coefficient_is_the_one_by_hand() -> None:
    assert data("heiles").proofs[1].leading == LEADING


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("mine", {"area_preserving": True, "order": None, "leading": "0"}),
        ("heiles", {"symplectic": True, "area_preserving": True, "order": None, "leading": {}}),
    ],
)
def test_what_is_said_to_be_preserved_and_is_not_is_found(
    name: str, changes: dict[str, Any]
) -> None:
    of = data(name)
    for field, value in changes.items():
        of = changed(of, ["proofs", 1, field], value)
    assert again(of, "proof", 1).differences[0].column == "order"


@pytest.mark.parametrize("step", [-1, 1])
@pytest.mark.parametrize("name", ["leaves", "pole-in-degrees"])
def test_the_step_that_left_the_range_is_found_again(name: str, step: int) -> None:
    of = data(name)
    places = [
        ["runs", k, "rows", j, "failed_step"]
        for k, run in enumerate(of.runs)
        for j, row in enumerate(run.rows)
        if row.failed_step
    ]
    assert places
    for place in places:
        found = again(changed(of, place, lambda number: number + step), "run", place[1])
        columns = [x.column for x in found.differences]
        assert columns == ["failed_step"] or (step < 0 and columns == ["status"])


@pytest.mark.parametrize("name", POLES)
def test_an_orbit_that_is_not_defined_any_more_has_left(name: str) -> None:
    """All rows after are of the step that left."""
    of = data(name)
    statuses = [row.status for row in of.runs[0].rows]
    assert statuses == ["finished", "finished", "left range", "left range"]
    found = again(of, "run", 0)
    assert (found.differences, found.not_recomputed, found.recomputed) == ([], [], 4)


def test_an_orbit_that_is_said_to_leave_and_does_not_is_found() -> None:
    of = data("mine")
    nothing = dict.fromkeys(("kind", "p", "q", "delta_j", "mse", "lambda"))
    row = {"step": 30, "status": "left range", "failed_step": 12, **nothing}
    found = again(changed(of, ["runs", 1, "rows", 3], row), "run", 1)
    assert isinstance(found.differences[0], FileDifference)
    assert found.differences[0].column == "status"


def test_a_scheme_that_is_not_known_here_is_named() -> None:
    toml = OTHERS["other"].replace(_SCHEMES, '["ruth3"]')
    of = made({"unknown": toml})[0]
    for kind in ("run", "proof"):
        found = again(of, kind, 0)
        assert "ruth3" in found.not_recomputed[0]
        assert found.recomputed == 0
