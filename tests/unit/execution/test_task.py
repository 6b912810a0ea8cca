"""Every kind of task carries all that is asked of it: its result, its cost, how it is performed."""

import inspect
import pickle
import pkgutil
import re
from collections.abc import Iterator
from importlib import import_module
from typing import Any, get_args

import pytest

import verify
from verify.execution.task import Task
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen


def kinds() -> list[type[Task]]:
    for module in pkgutil.walk_packages(verify.__path__, "verify."):
        parent, _, name = module.name.rpartition(".")
        if name in ("task", "tasks") or parent in ("verify.studies.kinds", "verify.reference.make"):
            import_module(module.name)
    return sorted(
        {kind for kind in subclasses(Task) if not inspect.isabstract(kind)},
        key=lambda k: k.__name__,
    )


def subclasses(cls: type[Task]) -> Iterator[type[Task]]:
    for kind in cls.__subclasses__():
        if kind.__module__.startswith("verify."):
            yield kind
            yield from subclasses(kind)


KINDS = kinds()


def test_there_are_kinds_and_no_two_have_one_name() -> None:
    names = [kind.model_fields["kind"].default for kind in KINDS]
    assert len(names) == len(set(names)) >= 15
    assert {"proof", "run", "separation", "hunt", "orbit"} <= set(names)


@pytest.mark.parametrize("kind", KINDS)
def test_each_says_what_it_gives_and_performs_itself(kind: type[Task]) -> None:
    assert issubclass(kind.result, Frozen)
    returned = inspect.signature(kind.compute).return_annotation
    one_of = get_args(returned) or (returned,)  # of a base's tasks
    assert {kind.result, kind.result.__name__} & {*one_of}
    assert list(inspect.signature(kind.compute).parameters) == ["self", "keeper"]


@pytest.mark.parametrize("kind", KINDS)
def test_what_it_imports_when_it_computes_is_what_it_says(kind: type[Task]) -> None:
    called = kind.prepare if kind.alone else kind.compute  # by workers
    inside = set(re.findall(r"^ +from (verify\S+) import", inspect.getsource(called), re.MULTILINE))
    assert inside == set(kind.imports)


def run(**changes: Any) -> RunTask:
    fields = {
        "hamiltonian": "p**2/2 + q**2/2", "parameters": {}, "scheme": "lie2", "q": 1, "p": 0,
        "step_size": "0.1", "steps": 10, "arithmetic": "float64", "digits": 17,
        "observables": ("lambda",), "points": 0,
    }  # fmt: skip
    return RunTask.model_validate(fields | changes)


def test_equal_tasks_have_one_key_and_others_another() -> None:
    assert run().key == run(step_size="1/10").key
    assert run().key != run(steps=11).key
    assert run() == pickle.loads(pickle.dumps(run()))  # noqa: S301 - our own


def test_a_task_costs_more_in_a_slower_arithmetic_and_for_more_steps() -> None:
    many = 10**7
    costs = [
        run(steps=many, arithmetic=name).cost for name in ("float64", "fixed", "mpfr", "mpmath")
    ]
    assert costs == sorted(costs)
    once, twice, thrice = (run(steps=k * many).cost for k in (1, 2, 3))
    assert once < twice < 2 * once
    assert thrice - twice == twice - once
    in_mpfr = [run(steps=n, arithmetic="mpfr").cost for n in (10, 10_000)]
    assert [run(steps=n).cost for n in (10, 10_000)] == in_mpfr  # what float64 is held against


def test_a_task_is_described_for_an_error() -> None:
    assert run().description.startswith("run of hamiltonian=p**2/2 + q**2/2, scheme=lie2")
