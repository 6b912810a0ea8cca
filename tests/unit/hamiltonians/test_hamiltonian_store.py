"""A Hamiltonian that was kept is the one that was read; what is to be read again is not kept."""

import json
import pickle
import re
import subprocess
import sys
from fractions import Fraction
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.imports import NAMES, rooms_of
from tests.paths import ROOT
from tests.unit.test_imports import GROUND, edges_of
from verify import strategies
from verify.algebra.ring import record_of, ring_from_record
from verify.arithmetic.exact import text
from verify.code_cache import OFF, VARIABLE
from verify.errors import InputError
from verify.hamiltonians import hamiltonian_store, systems
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.hamiltonian_store import load_or_read

NUMBER = count()
FORMULAS = [
    "p**2/2 - cos(q)",
    "p**2/2 + q**2/2 + 3*q**4/7",
    "p1**2/2 + p2**2/2 + p3**2/2 + cos(q1 - q2)*exp(-q3**2) + q2*q3**3/3",
    "p1**2/2 + q1**4/4",
    "p1*p2 + q1**2*q2 + sin(t)*q1",
    "p*q",
    "7",
    "exp(-q**2)*(1 + p**2) + sinh(p)*cosh(q) + tanh(q/2)",
    "sqrt(1 + p**2 + q**2) + atan(q)/(2 + q**2) + pi*q",
    "log(2 + cos(q)) + 1/(3 + sin(p)*cos(2*q))",
    "p**2/2 + q**2*cos(2*pi*t) + exp(t)*q",
    f"p**2/2 + {10**1100}*q**3/{7**1000}",
]


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


def is_read(hamiltonian: Hamiltonian) -> bool:
    """Whether its formula was read, and is not only kept."""
    return "expression" in vars(hamiltonian)


def twice(formula: str, **values: str) -> tuple[Hamiltonian, Hamiltonian]:
    """As it is read, and as the next process has it."""

    def read(given: object) -> Hamiltonian:
        assert given == values
        return Hamiltonian.parse(formula, values)

    source = f"formula {formula}, test {next(NUMBER)}"
    found = [load_or_read(source, values, read) for _ in range(2)]
    assert is_read(found[0])
    return found[0], found[1]


def anew(hamiltonian: Hamiltonian) -> CanonicalField:
    """Its field, in a ring that is shared with nobody."""
    ring, energy, _ = hamiltonian.embed_in_ring()
    return CanonicalField(ring, hamiltonian.coordinates, energy)


def of_field(field: CanonicalField) -> list[object]:
    """All that is in it, as texts."""
    ring = field.ring
    polynomials = (*field.slopes, field.energy)
    gradients = [
        {name: str(x) for name, x in ring.gradient(g.index).items()} for g in ring.generators
    ]
    relations = [(k, n, str(x)) for k, n, x in ring.relations]
    made = [(g.index, g.kind, str(g.argument), g.degree, g.name) for g in ring.generators]
    return [ring.variables, ring.room, made, relations, gradients, [*map(str, polynomials)]]


def recorded_field(record: Any) -> CanonicalField:
    ring, energy = ring_from_record(record)
    return CanonicalField(ring, PLANE, energy)


def same(one: Hamiltonian, other: Hamiltonian) -> None:
    assert not is_read(other)
    names = ("formula", "values", "parameters", "coordinates", "time_dependent", "symbols", "texts")
    for name in (*names, "planar", "degrees", "domain", "text_domain"):
        assert getattr(one, name) == getattr(other, name), name
    assert repr(one) == repr(other)
    assert of_field(anew(one)) == of_field(anew(other))
    assert not is_read(other), "nothing was read for that"
    assert one == other
    assert (one.expression, one.exact) == (other.expression, other.exact)


@pytest.mark.parametrize("formula", FORMULAS)
def test_what_was_kept_is_what_was_read(formula: str) -> None:
    same(*twice(formula))


@pytest.mark.parametrize("name", systems.all_systems())
def test_the_systems_are_kept_with_their_values_and_without(name: str) -> None:
    system = systems.get(name)
    for regime in system.regimes:
        values = {key: text(x) for key, x in system.regime(regime)[0].items()}
        one, other = twice(system.formula, **values)
        if one.domain:
            assert is_read(other)
            continue
        generic, kept_generic = one.with_symbols(), other.with_symbols()
        same(one, other)
        if values and not generic.domain:
            same(generic, kept_generic)
        assert kept_generic.expression == generic.expression


@drawn(40)
@given(strategies.hamiltonians())
def test_of_what_is_drawn_the_record_gives_the_same_field(drawn_one: Hamiltonian) -> None:
    field = anew(drawn_one)
    record = json.loads(json.dumps(record_of(field.ring, field.energy)))
    assert of_field(recorded_field(record)) == of_field(field)


def test_a_record_with_another_number_gives_another_field() -> None:
    field = anew(Hamiltonian.parse("p**2/2 - cos(q)"))
    record = json.loads(json.dumps(record_of(field.ring, field.energy)))
    record["element"][0][1] = "7"
    assert of_field(recorded_field(record)) != of_field(field)
    record = json.loads(json.dumps(record_of(field.ring, field.energy)))
    record["relations"] = []
    assert of_field(recorded_field(record)) != of_field(field)


@drawn(150)
@given(
    st.lists(
        st.sampled_from(["p", "q", "(p - q)", "(p + c)", "cos(q)", "3", "(a + 2)"]), min_size=2
    ),
    st.lists(st.sampled_from(["((q - b)**2 + 3)", "(p**2 + 5)", "(3 + b)"]), max_size=3),
    st.sampled_from(["0", "1/2", "-2"]),
)
def test_with_parameters_of_value_0_the_generic_h_is_the_same_expression(
    factors: list[str], divisors: list[str], b: str
) -> None:
    formula = f"{'*'.join(factors)}{''.join(f'/{x}' for x in divisors)} + a*p + b*q + c"
    one = Hamiltonian.parse(formula, {"a": 0, "b": b, "c": 0})
    record = hamiltonian_store._record_of(one)
    assert record is not None
    generic = Hamiltonian.from_record(record).with_symbols()
    assert generic.expression == one.with_symbols().expression
    assert of_field(canonical_field(generic)[0]) == of_field(anew(one.with_symbols()))


def test_a_generic_h_that_reads_back_otherwise_is_not_kept() -> None:
    formula = "p**2/2 + p/(3 + b)/((p - q)**2 + 3)"
    one, other = twice(formula, b="0")
    generic = one.with_symbols()
    assert Hamiltonian.parse(generic.formula).expression != generic.expression
    assert not is_read(other)
    assert other.with_symbols() == generic


@pytest.mark.parametrize(
    "formula",
    ["p**2/2 + log(q)", "p**2/2 + 1/q", "sqrt(q)**2 + p**2", "q**(1/3) + p", "p1*p2 + q1/q2"],
)
def test_what_has_a_domain_is_read_again(formula: str, cache: Path) -> None:
    one, other = twice(formula)
    assert is_read(other)
    assert one == other
    assert not cache.exists()


def test_other_values_another_text_and_other_code_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    def found(formula: str, **values: str) -> Hamiltonian:
        def read(_: object) -> Hamiltonian:
            return Hamiltonian.parse(formula, values)

        return load_or_read(formula, values, read)

    formula = "p**2/2 + delta*q**4/4"
    for source, value in ((formula, "1"), (formula, "1/2"), (formula + " ", "1")):
        assert is_read(found(source, delta=value))
        assert not is_read(found(source, delta=value))
    assert found(formula, delta="1/2").values == (("delta", Fraction(1, 2)),)
    assert found(formula, delta="1/2").exact != found(formula, delta="1").exact
    monkeypatch.setattr(hamiltonian_store, "_readers", lambda: "another version")
    assert is_read(found(formula, delta="1"))


def test_bad_input_is_refused_each_time(cache: Path) -> None:
    for _ in range(2):
        with pytest.raises(InputError, match="division by zero"):
            twice("p/0")
        with pytest.raises(InputError, match="no such parameter"):
            twice("p**2 + q**2", delta="1")
    assert not cache.exists()


def test_what_is_damaged_is_read_again(cache: Path) -> None:
    def found() -> Hamiltonian:
        return load_or_read("formula p*q", {}, lambda _: Hamiltonian.parse("p*q"))

    assert [is_read(found()), is_read(found())] == [True, False]
    (path,) = cache.iterdir()
    raw = bytearray(path.read_bytes())
    raw[-3] ^= 1
    path.write_bytes(bytes(raw))
    assert [is_read(found()), is_read(found())] == [True, False]


def test_where_the_code_is_not_there_to_look_at_nothing_is_kept(
    monkeypatch: pytest.MonkeyPatch, cache: Path
) -> None:
    hamiltonian_store._readers.cache_clear()
    monkeypatch.setattr(hamiltonian_store, "_CODE", ("none/*.py",))
    assert hamiltonian_store._readers() == ""
    assert is_read(twice("p**2/2 - cos(q)")[1])
    assert not cache.exists()
    hamiltonian_store._readers.cache_clear()


def test_all_rooms_that_read_a_formula_are_in_its_name() -> None:
    edges, seen = edges_of(NAMES), set()
    waiting = ["verify.hamiltonians.hamiltonian_store"]
    while waiting:
        module = waiting.pop()
        if module not in seen:
            seen.add(module)
            waiting += edges[module]
    above_ground = {rooms_of(module) for module in seen} - {*GROUND}
    assert {pattern.partition("/")[0] for pattern in hamiltonian_store._CODE} == above_ground


def test_without_a_folder_nothing_is_kept(monkeypatch: pytest.MonkeyPatch, cache: Path) -> None:
    monkeypatch.setenv(VARIABLE, OFF)
    assert is_read(twice("p**2/2 - cos(q)")[1])
    assert not cache.exists()


def test_what_is_too_long_is_not_kept(monkeypatch: pytest.MonkeyPatch, cache: Path) -> None:
    monkeypatch.setattr(hamiltonian_store, "_MOST_BYTES", 100)
    assert is_read(twice("p**2/2 - cos(q)")[1])
    assert not cache.exists()


def test_it_is_compared_pickled_and_given_values_as_what_it_is() -> None:
    one, other = twice("p**2/2 + delta*q**4/4", delta="1")
    again = twice("p**2/2 + delta*q**4/4", delta="1")[1]
    assert other is not again
    assert other == again
    assert hash(other) == hash(again)
    assert other == one
    assert one == other
    assert hash(other) == hash(one)
    assert other != again.with_values({"delta": 2})
    assert pickle.loads(pickle.dumps(other)) == one  # noqa: S301
    assert other.with_values({"delta": 2}) == one.with_values({"delta": 2})
    assert other.gradient()(1.0, 2.0) == one.gradient()(1.0, 2.0)
    field, (energy,) = canonical_field(other, one.exact)
    assert energy == field.energy


def test_what_was_added_to_the_shared_ring_is_not_kept() -> None:
    one = Hamiltonian.parse("p**2/2 + 1/(1 + q**2)")
    ring = canonical_field(one)[0].ring
    ring.add("exp", ring.variable("p"))
    assert [g.kind for g in canonical_field(one)[0].ring.generators][3:] == ["inverse", "exp"]
    same(*twice("p**2/2 + 1/(1 + q**2)"))


WITHOUT = """
import sys
from verify.commands.main import main
try:
    main(sys.argv[1:])
except SystemExit as done:
    assert not done.code, done.code
print("sympy" in sys.modules, file=sys.stderr)
"""
RUNS = [
    "run --system pendulum --scheme lie2 --digits 20",
    "run --system duffing --param delta=1 --scheme rk4",
    "run --hamiltonian p**2/2+exp(-q**2)*cos(3*t) --scheme lie3",
    "run --system duffing --param delta=1/3 --scheme stormer-verlet",
    "separate --system duffing --param delta=1 --scheme lie2",
]


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("command", RUNS)
def test_a_second_run_tells_the_same_without_sympy(command: str) -> None:
    told = []
    given = f"{command} --step-size 0.01 --steps 40 --q 1 --p 0 --json".split()
    for with_sympy in (True, False):
        done = subprocess.run(
            [sys.executable, "-c", WITHOUT, *given],
            capture_output=True, text=True, check=True, cwd=ROOT,
        )  # fmt: skip
        assert done.stderr.splitlines()[-1] == str(with_sympy)
        told.append(re.sub(r'"seconds": "[^"]*"', "", done.stdout))
    assert told[0] == told[1]
