"""What stands where something is to be kept, and is not ours to replace, is refused before work."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.constructed.plans import kept_in
from verify.errors import InputError
from verify.execution import execute as execution
from verify.execution.execute import execute
from verify.execution.executors import THIS_PROCESS
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan

IN_PLACE: dict[str, Callable[[Path], None]] = {
    "is a folder": lambda path: path.mkdir(),
    "is a link": lambda path: path.symlink_to("nowhere"),
    "is no regular file": lambda path: os.mkfifo(path),
    "is read-only": lambda path: path.touch(0o400),
}


@pytest.mark.parametrize(("problem", "put"), IN_PLACE.items(), ids=IN_PLACE)
def test_a_result_that_could_not_be_kept_is_refused_before_any_task(
    problem: str, put: Callable[[Path], None], tmp_path: Path, plan: Plan,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    def never(*_: object) -> None:
        raise AssertionError("a task is done")

    store = kept_in(tmp_path)
    path = store.path(sorted(plan.tasks)[-1])
    assert path is not None
    path.parent.mkdir(exist_ok=True)
    put(path)
    monkeypatch.setattr(execution, "compute_all", never)
    with pytest.raises(InputError, match=f"{path.name[-20:]}: {problem}"):
        execute(plan, store, where=THIS_PROCESS)


def test_a_kept_result_that_is_linked_or_read_only_is_taken_up(tmp_path: Path, plan: Plan) -> None:
    """The control: nothing is to be written there."""
    first = execute(plan, kept_in(tmp_path), where=THIS_PROCESS)
    store = kept_in(tmp_path)
    linked, locked = (store.path(name) for name in sorted(plan.tasks)[:2])
    assert linked is not None
    assert locked is not None
    locked.chmod(0o400)
    linked.symlink_to(linked.rename(tmp_path / "elsewhere.json"))
    assert execute(plan, store, where=THIS_PROCESS) == first
    assert store.taken == len(plan.tasks)


@pytest.mark.parametrize(("problem", "put"), IN_PLACE.items(), ids=IN_PLACE)
def test_a_checkpoint_that_could_not_be_kept_is_refused_as_it_is_looked_for(
    problem: str, put: Callable[[Path], None], tmp_path: Path
) -> None:
    keeper = Keeper(tmp_path, "task")
    keeper.save("run", {"steps": 3})
    assert keeper.load("run") == {"steps": 3}
    (path,) = tmp_path.iterdir()
    path.unlink()
    assert keeper.load("run") is None
    put(path)
    with pytest.raises(InputError, match=problem):
        keeper.load("run")
