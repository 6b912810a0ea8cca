"""Of a costly test with many parameters the suite runs some, chosen once for all.

`@pytest.mark.sample(3)` above such a test: three of its parameters, of which each brings as many
new values as it can, and has the least hash of those that bring as many. So they stay the same
until a test or a parameter is renamed. What `@pytest.mark.left_to_ci` stands above runs in CI, and
by hand where it is asked for: by `pytest -m left_to_ci`, by its name, or by `pytest --whole`, which
runs whatever there is.
"""

import os
from collections import defaultdict
from hashlib import sha256

import pytest

_LEFT = "left_to_ci"


def add_option(parser: pytest.Parser) -> None:
    """`--whole`, for campaigns."""
    parser.addoption("--whole", action="store_true", help="all parameters of sampled tests, too")


def add_markers(config: pytest.Config) -> None:
    """Our markers, which pytest would refuse as unknown."""
    config.addinivalue_line("markers", "sample(count): so many of its parameters are run")
    config.addinivalue_line("markers", f"{_LEFT}: it is run in CI, or where it is asked for")


def leave_out(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Takes those out of `items` that are not of the sample."""
    if config.getoption("--whole") or any("::" in asked for asked in config.args):
        return
    left = _unsampled(items)
    if not os.environ.get("CI") and config.getoption("-m") != _LEFT:
        left |= {item for item in items if item.get_closest_marker(_LEFT)}
    if left:
        config.hook.pytest_deselected(items=[item for item in items if item in left])
        items[:] = [item for item in items if item not in left]


def _unsampled(items: list[pytest.Item]) -> set[pytest.Item]:
    groups: dict[tuple[str, int], list[pytest.Item]] = defaultdict(list)
    for item in items:
        marker = item.get_closest_marker("sample")
        if marker is not None:
            groups[item.nodeid.partition("[")[0], *marker.args].append(item)
    return set().union(*(_beyond_sample(each, count) for (_, count), each in groups.items()))


def _beyond_sample(items: list[pytest.Item], count: int) -> set[pytest.Item]:
    """All but so many whose values of single parameters are not among those of the others."""
    by_hash = sorted(items, key=lambda item: sha256(item.nodeid.encode()).digest())
    left = {item: _values(item) for item in by_hash}
    seen: set[tuple[int, str]] = set()
    for _ in range(min(count, len(items))):
        best = max(left, key=lambda item: len(left[item] - seen))
        seen |= left.pop(best)
    return set(left)


def _values(item: pytest.Item) -> set[tuple[int, str]]:
    """By their names, which its own name has side by side."""
    return set(enumerate(item.nodeid.partition("[")[2].removesuffix("]").split("-")))
