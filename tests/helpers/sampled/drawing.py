"""What a strategy draws from random bytes, the same each time, and the simplest that it draws."""

import random
from collections.abc import Callable
from typing import Any

from hypothesis import Phase, find, given, settings
from hypothesis import strategies as st

_QUIET = settings(database=None, deadline=None)


def fuzzed(strategy: st.SearchStrategy[Any], count: int, seed: int = 0) -> list[Any]:
    """What `count` strings of random bytes give; fewer where some are not taken."""
    found: list[Any] = []

    @_QUIET
    @given(strategy)
    def test(drawn: Any) -> None:
        found.append(drawn)

    source = random.Random(seed)  # noqa: S311 - the same ones each time
    for _ in range(count):
        test.hypothesis.fuzz_one_input(source.randbytes(4096))
    return found


def shrunk(strategy: st.SearchStrategy[Any], holds: Callable[[Any], bool] = lambda _: True) -> Any:
    # What else fails is not asked for: to explain it takes four times as long as to find it.
    phases = (Phase.generate, Phase.shrink)
    own = settings(_QUIET, max_examples=2000, derandomize=True, phases=phases)
    return find(strategy, holds, settings=own)
