"""Scenes that say what a step keeps, also of equations without an H; what is refused, in a line."""

from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import GOOD, GRID, HEAD, SERIES, START, load
from verify.errors import InputError
from verify.hamiltonians.equations import Equations
from verify.scenes.scene import scene_from_toml, scene_text

FIELD = 'schemes = ["rk4"]\nfield = "u_dot = u*(v - a); v_dot = v*(1 - u)"\nparameters = {a = 2}\n'
PARTED = FIELD.replace("rk4", "A 1; B 1")
SPLIT = """
[[split]]
name = "A"
field = "u_dot = u*(v - a)"
[[split]]
name = "B"
field = "v_dot = v*(1 - u)"
"""
UV = "initial_values = [{ u = 1, v = 2 }]"
FORM = '[keeps]\nstructures = ["volume: 3"]\ndensity = "1/(u*v)"\nform = "du^dv/(u*v)"\n'


@pytest.mark.parametrize(
    "content", [HEAD + 'keeps = ["energy: 3", "area"]\n', FIELD, FIELD + FORM, GOOD]
)
def test_a_scene_is_read_as_it_is_written(content: str, tmp_path: Path) -> None:
    scene = load(tmp_path, content)
    assert scene_from_toml(scene_text(scene), "mine.toml") == scene


def test_a_field_takes_the_place_of_h_with_its_parameters(tmp_path: Path) -> None:
    system = load(tmp_path, FIELD).exact_hamiltonian()
    assert isinstance(system, Equations)
    assert (system.coordinates, system.symbols) == (("u", "v"), ())


@pytest.mark.parametrize("written", ['"volume"', '["volume"]', '{ structures = ["volume"] }'])
def test_a_text_and_a_list_are_short_for_a_table(written: str, tmp_path: Path) -> None:
    keeps = load(tmp_path, f"{HEAD}keeps = {written}\n").keeps
    assert keeps is not None
    assert keeps.structures == ("volume",)


def test_a_proof_asks_for_no_value_of_a_parameter_and_a_run_does(tmp_path: Path) -> None:
    symbolic = 'hamiltonian = "p**2/2 + a*q**4"\nschemes = ["lie2"]\nkeeps = ["energy: 3"]\n'
    assert load(tmp_path, symbolic).exact_hamiltonian().symbols == ("a",)
    with pytest.raises(InputError, match="parameter=a: has no value"):
        load(tmp_path, symbolic + GRID)


# name -> (content, what the message must hold)
BAD = {
    "unknown": (HEAD + 'keeps = ["volum"]', "keeps=volum: unknown; is volume meant"),
    "nothing": (HEAD + "keeps = []", "keeps: names nothing that is kept"),
    "no-texts": (HEAD + "keeps = [3]", "keeps.structures.0=3: must be a text"),
    "order": (HEAD + 'keeps = ["energy: x"]', "keeps=energy: x: the order behind the colon"),
    "no-integral": (HEAD + 'keeps = ["p"]', "keeps=p: is not kept by the exact flow"),
    "key": (FIELD + '[keeps]\nfrom = "x"', "keeps.from=x: unknown key; is form meant"),
    "form-name": (FIELD + '[keeps]\nform = "du^dw"', "keeps.form=w: unknown; allowed: u, v"),
    "form-not-kept": (FIELD + '[keeps]\nform = "du^dv"', "is not kept by the exact flow"),
    "density": (FIELD + '[keeps]\ndensity = "1/w"', "keeps.density=1/w: at column 3: unknown"),
    "casimir": (
        FIELD + '[keeps]\npoisson = "0, u*v; -u*v, 0"\ncasimirs = ["u"]',
        "keeps.casimirs=u: is no Casimir",
    ),
    "energy-of-a-field": (FIELD + 'keeps = ["energy"]', "keeps=energy: a system without H has"),
    "symplectic-of-a-field": (
        FIELD + 'keeps = ["symplectic"]',
        "keeps=symplectic: a system without H has no p and q; write form",
    ),
    "start-of-a-field": (FIELD + GRID, "initial_values.0=q: unknown; allowed: u, v"),
    "series-of-a-field": (FIELD + SERIES, "initial_value=q: unknown; allowed: u, v"),
    "start-without-v": (
        FIELD + GRID.replace(START, UV.replace(", v = 2", "")),
        "has no value of v",
    ),
    "start-of-an-h": (
        HEAD + GRID.replace(START, UV),
        "initial_values.0.u=1: unknown key; is one of",
    ),
    "start-no-number": (
        FIELD + GRID.replace(START, UV.replace("1", '"a"')),
        "grid.initial_values.0: u=a: not a finite number",
    ),
    "start-twice": (
        FIELD + GRID.replace(START, UV.replace("}]", "}, { v = 2, u = 1 }]")),
        "initial_values=2: one of them stands twice",
    ),
    "separate-of-a-field": (
        FIELD + GRID.replace(START, UV) + "separate = true",
        "has no H; grid.separate takes one",
    ),
    "growth-of-a-field": (FIELD + GRID.replace(START, UV) + "growth = true", "grid.growth takes"),
    "observable-of-a-field": (
        FIELD + GRID.replace(START, UV) + 'observables = ["energy_error_max"]',
        "observable=energy_error_max: unknown; allowed: ",
    ),
    "value-of-a-field": (
        FIELD.replace("{a = 2}", "{}") + GRID.replace(START, UV),
        "parameter=a: has no value",
    ),
    "reference-of-a-field": (
        FIELD + f"[[reference]]\nstep_sizes = [0.1]\nsteps = [1]\n{START}",
        "has no H; reference takes one",
    ),
    "criteria-of-a-field": (FIELD + "criteria = [1]", "has no H; criteria takes one"),
    "every-h-of-a-field": (
        FIELD + "every_hamiltonian = true",
        "has no H; every_hamiltonian takes one",
    ),
    "split-of-an-h": (HEAD + SPLIT, "split=A, B: no scheme is composed of its parts; write 'A 1; "),
    "split-and-an-h": (HEAD.replace("lie2", "A 1; B 1") + SPLIT, "split=A, B: are parts of equ"),
    "split-of-no-scheme": (FIELD + SPLIT, "no scheme is composed of its parts"),
    "split-unknown": (PARTED.replace("B 1", "C 1") + SPLIT, "scheme=C: unknown; allowed: A, B"),
    "split-sum": (
        PARTED + SPLIT.replace("1 - u", "1 + u"),
        "split=v_dot: the parts do not add up to the field: v*(u + 1), and the field has ",
    ),
    "split-no-shear": (
        PARTED + SPLIT.replace("u_dot = u*(v - a)", "u_dot = u*(v - a); v_dot = 0"),
        "split=A: u_dot = u*(-a + v): is a part with no flow that is a polynomial in time",
    ),
    "split-twice": (PARTED + SPLIT.replace('"B"', '"A"'), "split=2: a name stands twice"),
    "split-name": (PARTED + SPLIT.replace('"B"', '"B 1"'), "split=B 1: is no name of a part"),
    "split-empty": (PARTED + SPLIT.replace("v_dot = v*(1 - u)", ""), "split=B:: has other equ"),
    "split-key": (PARTED + SPLIT.replace('name = "B"', 'nam = "B"'), "split.1.nam=B: unknown key"),
    "split-table": (PARTED + 'split = { name = "A" }', "split={'name': 'A'}: must be a list"),
    "field-and-system": (FIELD + 'system = "duffing"', "give one of the two, or field"),
    "no-equation": (FIELD.replace("_dot", ""), "has no equation; write u_dot = "),
    "scheme": (FIELD.replace("rk4", "stormer-verlet"), "scheme=stormer-verlet: takes an H"),
    "parameter": (FIELD.replace("{a = 2}", "{b = 2}"), "parameter=b: H has no such parameter"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_one_is_refused_in_one_line_that_names_its_key(name: str, tmp_path: Path) -> None:
    content, message = BAD[name]
    with pytest.raises(InputError) as refused:
        load(tmp_path, content + "\n")
    assert str(refused.value).startswith("mine.toml: ")
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
    assert "--" not in str(refused.value)
