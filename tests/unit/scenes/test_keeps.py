"""Scenes that say what a step keeps, also of equations without an H; what is refused, in a line."""

from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import GOOD, GRID, HEAD, SERIES, load
from verify.errors import InputError
from verify.hamiltonians.equations import Equations
from verify.scenes.scene import scene_from_toml, scene_text

FIELD = 'schemes = ["rk4"]\nfield = "u_dot = u*(v - a); v_dot = v*(1 - u)"\nparameters = {a = 2}\n'
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
    "grid-of-a-field": (FIELD + GRID, "has no H; grid takes one, in p and q"),
    "series-of-a-field": (FIELD + SERIES, "has no H; series takes one"),
    "criteria-of-a-field": (FIELD + "criteria = [1]", "has no H; criteria takes one"),
    "every-h-of-a-field": (
        FIELD + "every_hamiltonian = true",
        "has no H; every_hamiltonian takes one",
    ),
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
