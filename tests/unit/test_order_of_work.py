"""What a process has made before changes no result: proofs and runs forwards, backwards, alone.

Maps, fields, programs and kernels are shared among all that ask for them, and are made by whoever
asks first; so a result is held against the same one of a process that makes nothing else.
"""

import json
import multiprocessing
from collections.abc import Sequence
from typing import Any

import pytest

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.runs.requested_run import run
from verify.schemes import get

HAMILTONIANS = {
    "p**2/2 + a*q**4/4": {"a": "3/2"},
    "p**2/2 + a*q**4/4 ": {"a": "-2/7"},  # the same H with another value
    "a*p**2*q/2 + q**2*p + q**2": {"a": "1/3"},
    "p**2/2 - cos(q) + sin(p + q)/5": {},
    "p**2/(2 + q**2) + exp(-q)": {},
}
SCHEMES = ("lie1", "lie3", "lie2", "rk4", "implicit-midpoint", "stormer-verlet")
Asked = tuple[str, str]
# Each H with four of the schemes, the first two with the same.
ALL: list[Asked] = [
    (text, scheme)
    for k, text in enumerate(HAMILTONIANS)
    for n, scheme in enumerate(SCHEMES)
    if (n + k // 2) % 3
]
START = {"q": "3/4", "p": "-1/3", "step_size": "1/50", "steps": 5}
RUNS: dict[str, tuple[str, ...]] = {
    "float64": ("lambda", "lambda_plain"),
    "mpmath": ("lambda_plain",),
    "mpfr": ("lambda", "mse", "delta_j_max"),
    "ball": ("lambda_max",),
}


def proved(asked: Asked, symbols: bool) -> dict[str, Any]:
    """All fields of the proof, parameters with their values or as symbols."""
    text, name = asked
    scheme, h = get(name), Hamiltonian.parse(text, {} if symbols else HAMILTONIANS[text])
    try:
        proof = prove(scheme.step_map(h), scheme)
    except InputError as error:
        return {"refused": str(error)}
    return {
        "verdict": proof.verdict.value,
        "reason": proof.reason,
        "order": proof.order,
        "leading": proof.first.text,
        "delta_j": proof.step_map.delta_j_text,
        "area": proof.area_preserving,
        "convergence": proof.convergence_order,
        "witness": {n: str(x) for n, x in proof.witness.items()},
        "enclosure": proof.enclosure,
    }


def ran(asked: Asked, arithmetic: str) -> dict[str, Any]:
    """All fields of the run, but for its time."""
    text, name = asked
    h, digits = Hamiltonian.parse(text, HAMILTONIANS[text]), 17 if arithmetic == "float64" else 25
    try:
        found = run(h, name, **START, arithmetic=arithmetic, digits=digits,
                    observables=RUNS[arithmetic])  # fmt: skip
    except InputError as error:
        return {"refused": str(error)}
    return {n: x for n, x in found.model_dump(mode="json").items() if n != "seconds"}


def results(asked: Sequence[Asked], backwards: bool = False) -> dict[Asked, str]:
    """Of each all its results as text; backwards: the last one first, and in it the last result."""
    found = {}
    for one in list(asked)[::-1] if backwards else asked:
        kernel_runs = [lambda one=one, s=s: proved(one, s) for s in (False, True)]
        kernel_runs += [lambda one=one, name=name: ran(one, name) for name in RUNS]
        order = range(len(kernel_runs))[::-1] if backwards else range(len(kernel_runs))
        made = {k: kernel_runs[k]() for k in order}
        found[one] = json.dumps([made[k] for k in range(len(kernel_runs))], sort_keys=True)
    return found


def alone(asked: Asked) -> str:
    return results([asked])[asked]


@pytest.fixture(scope="module")
def each_alone() -> dict[Asked, str]:
    """Of each its results in a process that has made nothing before it."""
    fresh = multiprocessing.get_context("forkserver")
    fresh.set_forkserver_preload([__name__])
    with fresh.Pool(2, maxtasksperchild=1) as pool:
        return dict(zip(ALL, pool.map(alone, ALL, chunksize=1), strict=True))


@pytest.mark.left_to_ci
@pytest.mark.parametrize("backwards", [False, True])
def test_results_are_those_of_a_process_that_has_made_nothing_else(
    each_alone: dict[Asked, str], backwards: bool
) -> None:
    together = results(ALL, backwards)
    assert [one for one in ALL if together[one] != each_alone[one]] == []


@pytest.mark.left_to_ci
def test_results_of_another_parameter_value_are_others(each_alone: dict[Asked, str]) -> None:
    one, two = (text for text in HAMILTONIANS if text.startswith("p**2/2 + a*q**4"))
    assert each_alone[one, "lie2"] != each_alone[two, "lie2"]  # so that a mix-up would be seen
