"""A run that was interrupted and goes on from its checkpoint: the same bits in every arithmetic.

Checkpoints that are damaged, or another task's, are not taken up.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from verify import arithmetic
from verify.execution import keeper as keeping
from verify.execution.keeper import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ChunkedLoop
from verify.runs.requested_run import run
from verify.scenes.observables import CLOSED_FORM, REPORTED
from verify.scenes.results.run import RunResult

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
STEPS, POINTS = 96, 6
NAMES = [name for name in arithmetic.names() if name != "ball"]  # whose runs keep nothing
every = pytest.mark.parametrize("name", NAMES)
Progress = Callable[[int], None]


def go(
    name: str,
    keeper: Keeper = keeping.NOTHING,
    progress: Progress | None = None,
    observables: tuple[str, ...] = CLOSED_FORM,
    **more: Any,
) -> RunResult:
    at: dict[str, Any] = {"q": "1.5", "p": "1/3", "step_size": "0.1", "steps": STEPS, "digits": 25}
    return run(PENDULUM, "lie2", arithmetic=name, keeper=keeper, progress=progress, points=POINTS,
               observables=observables, **at | more)  # fmt: skip


def bits(found: RunResult) -> dict[str, Any]:
    return found.model_dump(exclude={"seconds"})


class Interrupting:
    """A progress callback by which someone presses Ctrl-C when it is called for the nth time."""

    def __init__(self, nth: int) -> None:
        self.left = nth

    def __call__(self, done: int) -> None:
        self.left -= 1
        if self.left == 0:
            raise KeyboardInterrupt


def calls(name: str, **more: Any) -> int:
    """How often a run tells its progress."""
    told: list[int] = []
    go(name, progress=told.append, **more)
    return len(told)


@pytest.mark.sample(4)
@every
@pytest.mark.parametrize("observables", [CLOSED_FORM, REPORTED], ids=["certified", "plain-too"])
def test_a_run_that_is_interrupted_anywhere_goes_on_to_the_same_bits(
    name: str, observables: tuple[str, ...], tmp_path: Path
) -> None:
    true = bits(go(name, observables=observables))
    assert (true["status"], len(true["series"])) == ("finished", POINTS)
    for nth in range(1, calls(name, observables=observables) + 1):
        keeper = Keeper(tmp_path, f"task-{nth}-")
        with pytest.raises(KeyboardInterrupt):
            go(name, keeper, Interrupting(nth), observables)
        assert list(tmp_path.glob(f"task-{nth}-*.checkpoint"))
        assert bits(go(name, keeper, observables=observables)) == true


@every
def test_a_run_that_is_interrupted_again_and_again_ends_with_the_same_bits(
    name: str, tmp_path: Path
) -> None:
    keeper, interruptions = Keeper(tmp_path, "task"), 0
    while True:
        try:
            found = go(name, keeper, Interrupting(1))
        except KeyboardInterrupt:
            interruptions += 1
            assert interruptions < 500, "it does not get on"
            continue
        break
    assert interruptions >= POINTS - 1
    assert bits(found) == bits(go(name))


@pytest.mark.sample(2)
@every
def test_a_run_that_needs_more_digits_than_it_began_with_does_so_after_an_interruption_too(
    name: str, tmp_path: Path
) -> None:
    """Whether the digits will do is asked at the first checkpoint, which then lies behind."""
    more: dict[str, Any] = {"q": "3.14159", "p": 0, "step_size": "0.25", "steps": 400}
    true = bits(go(name, **more))
    assert true["error_kind"] == "enclosed" or name == "float64"
    for nth in range(1, calls(name, **more) + 1):
        keeper = Keeper(tmp_path, f"task-{nth}-")
        with pytest.raises(KeyboardInterrupt):
            go(name, keeper, Interrupting(nth), **more)
        assert bits(go(name, keeper, **more)) == true


@every
@pytest.mark.parametrize("method", ["_note", "_extremes", "_point"])
def test_an_interruption_amid_a_note_loses_the_chunk_and_nothing_else(
    name: str, method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    true, original = bits(go(name)), getattr(ChunkedLoop, method)
    for nth in (1, 2, 4):
        keeper, left = Keeper(tmp_path, f"task-{nth}-"), [nth]

        def interrupted(self: ChunkedLoop, *arguments: Any, left: list[int] = left) -> Any:
            left[0] -= 1
            if left[0] == 0:
                original(self, *arguments)
                raise KeyboardInterrupt
            return original(self, *arguments)

        with monkeypatch.context() as patch:
            patch.setattr(ChunkedLoop, method, interrupted)
            with pytest.raises(KeyboardInterrupt):
                go(name, keeper)
        assert bits(go(name, keeper)) == true


# -- checkpoints that are of no use ---------------------------------------------------------------


def checkpoint(name: str, folder: Path) -> tuple[Keeper, Path]:
    keeper = Keeper(folder, "task")
    with pytest.raises(KeyboardInterrupt):
        go(name, keeper, Interrupting(3))
    (path,) = folder.glob("task-*.checkpoint")
    return keeper, path


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "nothing": lambda content: b"",
    "half": lambda content: content[: len(content) // 2],
    "a-byte-less": lambda content: content[:-1],
    "a-byte-more": lambda content: content + b"0",
    "no-text": lambda content: b"\xff\xfe" + content,
    "a-list": lambda content: b"[]",
    "a-number": lambda content: b"7\n7",
    "no-state": lambda content: b"{}\n{}",
    "two-lines": lambda content: content + b"\n" + content,
}


@every
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_checkpoint_is_not_taken_up(name: str, damage: str, tmp_path: Path) -> None:
    keeper, path = checkpoint(name, tmp_path)
    path.write_bytes(DAMAGES[damage](path.read_bytes()))
    told: list[int] = []
    assert bits(go(name, keeper, told.append)) == bits(go(name))
    assert told[0] <= STEPS // POINTS, "it begins anew"


@pytest.mark.sample(2)
@every
def test_a_checkpoint_with_one_digit_changed_is_not_taken_up(name: str, tmp_path: Path) -> None:
    """It reads well, and its state is another one."""
    keeper, path = checkpoint(name, tmp_path)
    content, true = path.read_text(), bits(go(name))
    at = content.index('"state"')
    for k in range(0, 200, 7):
        place = at + 12 + k
        changed = "3" if content[place] != "3" else "5"
        path.write_text(content[:place] + changed + content[place + 1 :])
        assert bits(go(name, keeper)) == true


@pytest.mark.sample(2)
@every
def test_a_checkpoint_is_taken_up_by_the_same_run_alone(name: str, tmp_path: Path) -> None:
    keeper, path = checkpoint(name, tmp_path)
    kept = path.read_bytes()
    for other in (
        {"digits": 60}, {"step_size": "0.2"}, {"q": "1.25"}, {"p": 0}, {"steps": 200},
    ):  # fmt: skip
        more: dict[str, Any] = other
        assert bits(go(name, keeper, **more)) == bits(go(name, **more))
        assert path.read_bytes() == kept
    told: list[int] = []
    go(name, keeper, told.append)
    assert told[0] > 3 * STEPS // POINTS, "the same run goes on"


@every
def test_a_task_that_is_done_forgets_its_checkpoints_and_no_others(
    name: str, tmp_path: Path
) -> None:
    keeper, path = checkpoint(name, tmp_path)
    others = [tmp_path / "tasks-1-2.checkpoint", tmp_path / "task.json"]
    for other in others:
        other.write_text("{}")
    keeper.clear()
    assert not path.exists()
    assert all(other.exists() for other in others)
    keeper.clear()
    assert bits(go(name, keeper)) == bits(go(name))


def test_a_checkpoint_is_written_when_some_seconds_have_passed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [0.0]
    monkeypatch.setattr(keeping.time, "monotonic", lambda: now[0])
    keeper, ages = Keeper(tmp_path, "task"), []

    def tick(done: int) -> None:
        ages.append([json.loads(p.read_text())["data"]["data"]["done"]
                     for p in tmp_path.glob("*.checkpoint")])  # fmt: skip
        now[0] += 2.0

    go("mpfr", keeper, tick)
    assert ages[0] == []
    assert ages[-1] != []
