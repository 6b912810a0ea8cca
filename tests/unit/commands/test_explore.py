"""The exit status of `verify explore`: what fails now, or still, fails it."""

from pathlib import Path

import pytest

from verify.commands.explore import _explore
from verify.execution.executors import LOCAL_DEFAULT
from verify.exploration import exploring
from verify.exploration.exploring import Exploration
from verify.scenes.results.exploration import EarlierFailure, ExploreReport, ShrunkResult

ASKED = Exploration(seed=0, examples=1, properties=("time-scaling",))
NOW = ShrunkResult(property="time-scaling", example=0, message="it is not so", scene="x = 1\n")


def again(message: str) -> EarlierFailure:
    """A scene that an earlier exploration found; empty: it holds now."""
    return EarlierFailure(file="a.toml", property="time-scaling", message=message)


@pytest.mark.parametrize(
    ("failures", "earlier", "failed"),
    [
        ((), (), False),
        ((NOW,), (), True),
        ((), (again("it is not so"),), True),
        ((), (again(""), again("it is not so")), True),
        ((), (again(""), again("")), False),
        ((NOW,), (again(""),), True),
    ],
)
def test_what_fails_now_or_still_is_the_exit_status(
    failures: tuple[ShrunkResult, ...],
    earlier: tuple[EarlierFailure, ...],
    failed: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    report = ExploreReport(seed=0, examples=1, properties=(), failures=failures, again=earlier)
    monkeypatch.setattr(exploring, "explore", lambda *_, **__: report)
    answer = _explore(ASKED, {}, tmp_path, None, LOCAL_DEFAULT)
    assert (answer.failed, answer.problem) == (failed, None)
