"""What a caller may give: systems, schemes and numbers in every form, and what is refused."""

import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import verify
from tests.helpers.maps import by_formulas
from verify import Hamiltonian, InputError
from verify.calls.inputs import hamiltonian_from, scheme_name
from verify.schemes import get

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
START = {"q": "1.5", "p": 0, "step_size": "0.1", "steps": 5}
EULER = "p_next = p - h*(q + q**3); q_next = q + h*p_next"


@pytest.mark.parametrize(
    "system",
    ["duffing", " Duffing ", verify.systems.get("duffing"), DUFFING,
     "p**2/2 + q**2/2 + delta*q**4/4", DUFFING.with_values({})],
    ids=repr,
)  # fmt: skip
def test_a_system_is_a_name_a_formula_or_a_hamiltonian(system: object) -> None:
    assert hamiltonian_from(system, {"delta": 1}) == DUFFING


def test_parameters_stand_beside_those_that_a_hamiltonian_has() -> None:
    both = Hamiltonian.parse("a*p**2 + b*q**2", {"a": 1})
    assert hamiltonian_from(both, {"b": 0.1}).values == (("a", 1), ("b", Fraction(1, 10)))
    assert hamiltonian_from(both) is both


@pytest.mark.parametrize("name", ["p", "q", "p*q", "p + q"])
def test_a_coordinate_alone_is_a_formula(name: str) -> None:
    assert hamiltonian_from(name) == Hamiltonian.parse(name)


def lambda_of(scheme: object) -> verify.RunResult:
    return verify.run(DUFFING, scheme, digits=25, **START)


def test_a_scheme_is_a_name_formulas_a_scheme_or_a_step_map() -> None:
    wanted = lambda_of("symplectic-euler")
    whole = by_formulas(DUFFING, "p - h*(q + q**3)", "q + h*p_next")
    own = replace(get("symplectic-euler"), name="mine")
    for scheme in ("Symplectic Euler", get("symplectic-euler"), whole, EULER, own):
        found = lambda_of(scheme)
        assert found.values["q"] == wanted.values["q"], scheme
        assert found.values["p"] == wanted.values["p"], scheme
    assert lambda_of("lie2").values["q"] != wanted.values["q"]


def test_a_scheme_that_only_bears_a_known_name_is_run_as_it_is() -> None:
    false = replace(get("lie2"), name="rk4")
    assert scheme_name(get("rk4"), DUFFING) == "rk4"
    assert scheme_name(false, DUFFING).startswith("p_next = ")
    assert lambda_of(false).values == lambda_of("lie2").values != lambda_of("rk4").values


def test_numbers_of_numpy_go_everywhere() -> None:
    plain = verify.run("pendulum", "lie2", q=1.5, p=0, step_size=0.1, steps=5)
    of_numpy = verify.run(
        "pendulum", "lie2", q=np.float64(1.5), p=np.int64(0), step_size=np.float32(0.1),
        steps=np.int64(5), points=np.int32(3),
    )  # fmt: skip
    assert plain.step_size == of_numpy.step_size == "0.1"
    assert plain.values == of_numpy.values
    assert len(of_numpy.orbit) == 4
    common = {"q": 1, "p": 0}
    assert verify.separate("pendulum", "lie2", step_size=0.1, steps=np.int64(3), **common).plain
    grid = verify.separate_grid(
        "pendulum", "lie2", step_sizes=np.array([0.1, 0.05]), time=np.float64(1), **common
    )
    assert [point.steps for point in grid.points] == [10, 20]
    judged = verify.stability("pendulum", "lie2", step_size=0.1, steps=np.int64(10), **common)
    assert judged[0].steps == 10
    carried = verify.flow("pendulum", "lie2", step_size=0.1, steps=np.array([1, 2]), exact=False)
    assert [image.steps for image in carried.images] == [1, 2]


OTHER = by_formulas(Hamiltonian.parse("p**2/2 + q**2"), "p - 2*h*q", "q + h*p_next")
WRONG: dict[str, tuple[Callable[[], object], str]] = {
    "a name like one": (
        lambda: verify.run("dufing", "lie2", **START),
        "system=dufing: unknown; is duffing meant",
    ),
    "a number": (lambda: verify.run(3, "lie2", **START), "system=3: is no system"),
    "a list": (lambda: verify.prove(["duffing"], "lie2"), "is no system"),
    "a callable": (
        lambda: verify.run(DUFFING, lambda p, q, h: (p, q), **START),
        "verify.check takes a step function",
    ),
    "none": (lambda: verify.prove("duffing"), "scheme: is missing"),
    "a scheme's number": (lambda: verify.run(DUFFING, 2, **START), "scheme=2: is no scheme"),
    "a scheme like one": (lambda: verify.run(DUFFING, "lei2", **START), "is lie2 meant"),
    "another map": (lambda: verify.run(DUFFING, OTHER, **START), "is that of the step map"),
    "parameters": (
        lambda: verify.run("duffing", "lie2", parameters=["delta"], **START),
        "not a mapping",
    ),
    "no value": (lambda: verify.run("duffing", "lie2", **START), "parameter=delta: has no value"),
    "no number": (
        lambda: verify.run(DUFFING, "lie2", **{**START, "q": None}),
        "q=None: not a number",
    ),
    "an array": (
        lambda: verify.run(DUFFING, "lie2", **{**START, "p": np.zeros(2)}),
        "not a number",
    ),
    "half a step": (
        lambda: verify.run(DUFFING, "lie2", **{**START, "steps": 2.5}),
        "steps=2.5: must be a whole number",
    ),
    "both": (lambda: verify.run(DUFFING, "lie2", **START, time=1), "give one of the two"),
    "short": (
        lambda: verify.run(DUFFING, "lie2", q=1, p=0, step_size=1, time=0.5),
        "makes 0 steps",
    ),
    "points": (lambda: verify.run(DUFFING, "lie2", **START, points=10_001), "points=10001"),
    "digits": (
        lambda: verify.run(DUFFING, "lie2", **START, digits="30"),
        "digits=30: must be a whole",
    ),
    "arithmetic": (
        lambda: verify.run(DUFFING, "lie2", **START, arithmetic=64),
        "is no name of a number system",
    ),
    "observables": (
        lambda: verify.run(DUFFING, "lie2", **START, observables="lamda"),
        "observable=lamda: unknown; is lambda meant",
    ),
    "progress": (lambda: verify.run(DUFFING, "lie2", **START, progress="bar"), "progress=bar"),
    "centre": (lambda: verify.flow(DUFFING, "lie2", step_size=1, steps=1, centre=3), "is no pair"),
    "shape": (lambda: verify.flow(DUFFING, "lie2", step_size=1, steps=1, shape="dog"), "shape"),
    "no sizes": (
        lambda: verify.bench(DUFFING, "lie2", q=1, p=0, time=1, step_sizes=[]),
        "is empty",
    ),
    "one size": (
        lambda: verify.bench(DUFFING, "lie2", q=1, p=0, time=1, step_sizes=[0.1]),
        "is one; an order takes two",
    ),
    "long": (
        lambda: verify.bench(DUFFING, "lie2", q=1, p=0, time=1, step_sizes=[3, 0.1]),
        "step_size=3: makes 0 steps",
    ),
    "claims": (lambda: verify.check(DUFFING, "lie2", order=0), "order=0: must be a whole number"),
    "half a point": (
        lambda: verify.check(DUFFING, lambda p, q, h: (p, q), p=1),
        "give both or none",
    ),
    "a sweep's option": (
        lambda: verify.sweep(DUFFING, "lie2", **START, workers=2),
        "workers=2: unknown",
    ),
}


@pytest.mark.parametrize("call", WRONG)
def test_what_is_wrong_is_one_line_that_names_it(call: str) -> None:
    made, said = WRONG[call]
    with pytest.raises(InputError, match=re.escape(said)) as error:
        made()
    assert "\n" not in str(error.value)
