"""What a claim in a file speaks of, and that nothing else is planned."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.unit.scenes.test_toml_lines import HEAD, MSE, write
from verify.claims.claims_file import ClaimsFile, load_claims
from verify.claims.kinds.numbers.value import ValueClaim
from verify.claims.verdicts import prepare
from verify.errors import InputError
from verify.execution.execute import Store

SCENE = 'system = "duffing"\nparameters = { delta = 2 }\nschemes = ["lie2"]\n'
GRID = "[grid]\ntime = 3\nstep_sizes = [0.1, 0.2]\ninitial_values = [{ q = 1, p = 0 }]\n"


def scene_of(file: ClaimsFile, index: int = 0) -> Any:
    return file.scenes[file.claims[index].scene]


def test_a_scene_is_a_file_beside_the_claims_or_a_table_in_them(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(SCENE + GRID)
    claim = '[[claim]]\nid = "a"\nkind = "order"\norder = 3\nscheme = "lie2"\nscene = "mine"\n'
    beside = load_claims(write(tmp_path, claim))
    assert scene_of(beside).parameters == {"delta": Fraction(2)}
    table = f'[[scene]]\nname = "mine"\n{SCENE}\n'.replace("2 }", "7 }")
    inside = load_claims(write(tmp_path, table + claim))
    assert scene_of(inside).parameters == {"delta": Fraction(7)}


def test_what_a_claim_does_not_say_of_its_runs_is_the_scenes(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(SCENE + GRID)
    head = '[[claim]]\nid = "a"\nscheme = "lie2"\nscene = "mine"\n'
    file = load_claims(write(tmp_path, head + 'kind = "mse"\nprinted = 1\nstep_size = 0.3\n'))
    grid = scene_of(file).grid
    assert (grid.time, grid.step_sizes) == (3, (Fraction(3, 10),))
    assert [(s.q, s.p) for s in grid.initial_values] == [(1, 0)]
    assert (grid.arithmetic, grid.observables, grid.digits) == ("auto", ("mse",), 20)
    table = 'kind = "table"\nstep_sizes = [0.1]\nprinted = [1]\n'
    file = load_claims(write(tmp_path, head + table))
    assert scene_of(file).name == "mine", "the scene's own runs are taken"
    file = load_claims(write(tmp_path, head + table + "steps = 7\n"))
    assert scene_of(file).grid.steps == 7


def test_a_claims_own_keys_stand_before_the_defaults(tmp_path: Path) -> None:
    content = """
[defaults]
scheme = "lie2"
system = "duffing"
parameters = { delta = 1 }
time = 3
step_size = 0.1
step_sizes = [0.1, 0.2]
initial_values = [{ q = 1, p = 0 }, { q = 2, p = 0 }]
q = 5
p = 6
[[claim]]
id = "a"
kind = "mse"
printed = 1
steps = 4
[[claim]]
id = "b"
kind = "bounded"
bound = 1
[[claim]]
id = "c"
kind = "order"
order = 3
hamiltonian = "p**2/2"
[[claim]]
id = "d"
kind = "order"
order = 3
every = "hamiltonian"
[[claim]]
id = "f"
kind = "order"
order = 3
parameters = { delta = 9 }
[[claim]]
id = "e"
kind = "bounded"
bound = 1
q = 7
p = 8
step_size = 0.5
"""
    file = load_claims(write(tmp_path, content))
    grid = scene_of(file, 0).grid
    assert (grid.steps, grid.time, grid.step_sizes) == (4, None, (Fraction(1, 10),))
    assert [(s.q, s.p) for s in grid.initial_values] == [(5, 6)]
    grid = scene_of(file, 1).grid
    assert (len(grid.step_sizes), len(grid.initial_values), grid.time) == (2, 2, 3)
    assert scene_of(file, 2).parameters == {}
    assert file.claims[3].scene == ""
    assert (scene_of(file, 4).system, scene_of(file, 4).parameters) == ("duffing", {"delta": 9})
    grid = scene_of(file, 5).grid
    assert [(s.q, s.p) for s in grid.initial_values] == [(7, 8)]
    assert grid.step_sizes == (Fraction(1, 2),)


def test_numbers_of_a_file_are_the_decimals_that_are_written(tmp_path: Path) -> None:
    content = HEAD + MSE.replace('"1e-9"', "-7.3010").replace("0.1", "0.001")
    file = load_claims(write(tmp_path, content))
    claim = file.claims[1]
    assert isinstance(claim, ValueClaim)
    assert claim.printed == "-7.3010"
    assert scene_of(file, 1).grid.step_sizes == (Fraction(1, 1000),)


# -- only what is needed --------------------------------------------------------------------------


def test_only_what_the_chosen_claims_need_is_planned(tmp_path: Path) -> None:
    file = load_claims(write(tmp_path, HEAD + MSE))
    assert len(prepare(file).plan.tasks) == 1
    assert prepare(file, ["first"]).plan.tasks == {}
    assert [c.id for c in prepare(file, ["m*", "first"]).claims] == ["first", "mine"]
    with pytest.raises(InputError, match="--only=other: no claim has this id; there are: first"):
        prepare(file, ["first", "other"])


def test_two_claims_on_one_run_share_it(tmp_path: Path) -> None:
    more = '[[claim]]\nid = "again"\n' + MSE.replace("1e-9", "2e-9")
    assert len(prepare(load_claims(write(tmp_path, HEAD + MSE + more))).plan.tasks) == 1


def test_a_map_that_is_not_smooth_in_h_leaves_its_claim_undecided(tmp_path: Path) -> None:
    scheme = "p_next = p + q*sqrt(h); q_next = q"
    kind = 'kind = "convergence_order"\nconvergence_order = 1\n'
    content = HEAD + f'{kind}scheme = "{scheme}"\n'
    *_, found = prepare(load_claims(write(tmp_path, content))).run(Store(None))
    assert found.verdict == "UNDECIDED"
    assert "not smooth in h" in found.evidence
