"""What a kind of claims does not take is refused as the file is read, by its line and its kind."""

import json
from pathlib import Path
from typing import Any

import pytest

from verify.claims.base_claim import Claim
from verify.claims.claims_file import load_claims
from verify.claims.kinds import models
from verify.errors import InputError

STATES = {"q": [1, 0], "p": [0, 1]}
IN_TIME = "p**2/2 + q**2/2 + q*cos(t)"
TWO_DEGREES = "p1**2/2 + p2**2/2 - 1/sqrt(q1**2 + q2**2)"
RUN: dict[str, Any] = {"step_size": "0.01", "steps": 100}
RUNS: dict[str, Any] = {"step_sizes": ["0.1", "0.2"], "steps": 20}
# The keys of each kind that speaks of an H and a scheme; the rest speaks of none of its own.
KEYS: dict[str, dict[str, Any]] = {
    "area_preserving": {"area_preserving": False},
    "symplectic": {"symplectic": False},
    "order": {"order": 3},
    "defect_order": {"defect_order": 3},
    "convergence_order": {"convergence_order": 2},
    "keeps": {"keeps": "volume"},
    "step_map": {"p_next": "p", "q_next": "q"},
    "jacobian": {"entries": [["1", "0"], ["0", "1"]]},
    "delta_j": {"formula": "h**3", "up_to": 4},
    "lambda": {**RUN, "printed": "1e-5"},
    "mse": {**RUN, "printed": "1e-5"},
    "run_value": {**RUN, "of": "lambda", "printed": "1e-5"},
    "run_ratio": {**RUNS, "of": "lambda", "printed": "4"},
    "less": {**RUN, "quantity": "mse", "than": "abs_lambda"},
    "magnitude": {**RUN, "quantifier": "every", "exponents": {"abs_lambda": -5}},
    "growth": {**RUN, "growth": "linear"},
    "growth_bound": {**RUNS, "eta": 2, "c1": 1, "c2": 1},
    "criteria": {**RUN, "numbers": [1, 2, 3, 4]},
    "solution_error": {**RUN, "within": "0.1"},
    "shifted": {**RUN, "again": [{"kind": "less", "quantity": "mse", "than": "abs_lambda"}]},
    "replaced": {
        **RUN,
        "mse": "1/N",
        "again": [{"kind": "spread", "quantity": "mse", "factor": 2}],
    },
    "no_pattern": RUN,
    "bounded": {**RUN, "bound": 1},
    "monotone": {**RUNS, "quantity": "mse", "direction": "increases"},
    "spread": {**RUN, "quantity": "mse", "factor": 2},
    "alike": {**RUNS, "quantity": "mse"},
    "depends": {**RUNS, "of": ["mse"], "on": ["step_size"]},
    "table": {**RUNS, "printed": ["-1.0", "-2.0"]},
    "table_until": {**RUNS, "printed": ["-1.0", "-2.0"]},
}
OF_NO_SCHEME_AND_H = {"theorem", "printed_power", "flow_area", "flow_distance", "lambda_factor",
                      "stability_limit",
                      "mse_summand"}  # fmt: skip
OF_A_PARAMETER = {"table_for_some"}
PLANAR = {"step_map", "jacobian", "delta_j", "shifted", "solution_error"}


def written(
    folder: Path, kind: str, hamiltonian: str, state: dict[str, Any], source: str = "hamiltonian"
) -> Path:
    keys = KEYS[kind]
    own = {**keys, **(state if {"steps"} & keys.keys() else {})}
    lines = ['id = "c"', f'kind = "{kind}"', 'scheme = "lie2"', f'{source} = "{hamiltonian}"']
    path = folder / "claims.toml"
    text = [f"{key} = {_toml(value)}" for key, value in own.items()]
    path.write_text("\n".join(["[[claim]]", *lines, *text]) + "\n")
    return path


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(value)


def test_every_kind_is_held_to_it() -> None:
    assert set(models()) == KEYS.keys() | OF_NO_SCHEME_AND_H | OF_A_PARAMETER
    planar = {kind for kind in KEYS if issubclass(models()[kind], Claim) and models()[kind].planar}
    assert planar == PLANAR


@pytest.mark.parametrize("kind", sorted(KEYS))
def test_a_kind_takes_two_degrees_of_freedom_or_says_that_it_does_not(
    kind: str, tmp_path: Path
) -> None:
    path = written(tmp_path, kind, TWO_DEGREES, STATES)
    if kind not in PLANAR:
        assert [claim.kind for claim in load_claims(path).claims] == [kind]
        return
    said = f"kind={kind}: is of one degree of freedom; the H that it speaks of has 2"
    with pytest.raises(InputError, match=f"claims.toml:3: claim c: {said}"):
        load_claims(path)


@pytest.mark.parametrize("kind", sorted(KEYS))
def test_a_kind_takes_an_h_in_time_or_says_that_it_does_not(kind: str, tmp_path: Path) -> None:
    path = written(tmp_path, kind, IN_TIME, {"q": 1, "p": 0})
    if kind != "shifted":
        assert [claim.kind for claim in load_claims(path).claims] == [kind]
        return
    with pytest.raises(InputError, match=f"kind={kind}: is of an H without t, and so of no H"):
        load_claims(path)


@pytest.mark.parametrize("kind", sorted(KEYS))
def test_a_kind_takes_equations_without_an_h_or_says_that_it_does_not(
    kind: str, tmp_path: Path
) -> None:
    path = written(tmp_path, kind, "p_dot = q; q_dot = p*q", {"q": 1, "p": 0}, source="field")
    if kind == "keeps":
        path.write_text(path.read_text().replace("p*q", "p"))  # volume is kept by this one
        assert [claim.kind for claim in load_claims(path).claims] == [kind]
        return
    with pytest.raises(InputError, match=rf"claim c: kind={kind}: is of an H; of equations"):
        load_claims(path)
