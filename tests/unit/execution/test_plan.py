"""What is computed together: parts of an ensemble, costliest first, each in its tasks' turn."""

from fractions import Fraction
from typing import Literal

import pytest

from verify.execution.keeper import Keeper
from verify.execution.plan import groups
from verify.execution.task import Task
from verify.scenes.frozen import Frozen
from verify.scenes.region_sections import PlacedShape
from verify.studies.kinds.regions import FlowTask


class _Sized(Task):
    """Of some cost, with others of its letter."""

    result = Frozen
    kind: Literal["sized"] = "sized"
    letter: str = "a"
    size: int

    @property
    def cost(self) -> int:
        return self.size

    @property
    def ensemble(self) -> str | None:
        return self.letter or None

    def compute(self, keeper: Keeper) -> Frozen:
        return Frozen()


class _Rising(_Sized):
    """The least of them is first."""

    @property
    def turn(self) -> float:
        return self.size


def sizes(tasks: list[Task], workers: int) -> list[list[int]]:
    found = groups({str(k): task for k, task in enumerate(tasks)}, workers)
    assert sorted(name for part in found for name in part) == sorted(map(str, range(len(tasks))))
    return [[task.cost for task in part.values()] for part in found]


def test_what_costs_most_is_first_in_its_group_and_among_groups() -> None:
    tasks = [_Sized(letter=letter, size=n) for letter, n in [("a", 3), ("b", 9), ("a", 5)]]
    assert sizes([*tasks], 2) == [[9], [5, 3]]


def test_who_has_no_ensemble_goes_alone() -> None:
    assert sizes([_Sized(letter="", size=n) for n in (1, 2)], 2) == [[2], [1]]


@pytest.mark.parametrize(("kind", "first"), [(_Sized, 40), (_Rising, 21)])
def test_a_long_ensemble_is_cut_by_cost_and_each_part_has_its_turns(
    kind: type[_Sized], first: int
) -> None:
    long, short = sizes([kind(size=n) for n in range(1, 41)], 2)
    assert set(long) == set(range(21, 41))
    assert long[0] == first
    assert short == sorted(short, reverse=kind is _Sized)


def flow(map_name: str, steps: int, h: str = "1/100", delta: int = 1) -> FlowTask:
    return FlowTask(
        hamiltonian="p**2/2 + q**2/2 + delta*q**4/4", parameters={"delta": Fraction(delta)},
        map=map_name, shape=PlacedShape(shape="circle"), step_size=Fraction(h), steps=steps,
        digits=17, mean_lambda=False, distance=False,
    )  # fmt: skip


def test_a_region_s_maps_are_one_ensemble_in_the_order_of_their_times() -> None:
    tasks = [flow("lie2", 2000), flow("lie2", 500), flow("lie2", 3000, "1/1000"), flow("lie1", 500)]
    (found,) = groups({task.key: task for task in tasks}, 2)
    times = [task.step_size * task.steps for task in found.values() if isinstance(task, FlowTask)]
    assert times == sorted(times)
    others = [flow("lie2", 500), flow("lie2", 500, delta=2)]
    assert len(groups({task.key: task for task in others}, 2)) == 2
