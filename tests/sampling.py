"""Of a costly test with many parameters the suite runs some, chosen once for all.

`@pytest.mark.sample(3)` above such a test: three of its parameters, of which each brings as many
new values as it can, and has the least hash of those that bring as many. So they stay the same
until a test or a parameter is renamed. `@pytest.mark.left_to_ci`: none of them, and CI runs them
all by `pytest -m left_to_ci`. `pytest --whole` runs whatever there is, and so does naming a test.
"""

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
    config.addinivalue_line("markers", f"{_LEFT}: it is run where it is asked for, and by CI")


def leave_out(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Takes those out of `items` that are not of the sample."""
    if config.getoption("--whole") or any("::" in asked for asked in config.args):
        return
    left = _unsampled(items)
    if config.getoption("-m") != _LEFT:
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
    return {item for (_, count), each in groups.items() for item in _by_news(each)[count:]}


def _by_news(items: list[pytest.Item]) -> list[pytest.Item]:
    """Those first whose values of single parameters are not among those before them."""
    left = sorted(items, key=lambda item: sha256(item.nodeid.encode()).digest())
    found: list[pytest.Item] = []
    seen: set[tuple[int, str]] = set()
    while left:
        best = max(left, key=lambda item: len(_values(item) - seen))
        left.remove(best)
        found.append(best)
        seen |= _values(best)
    return found


def _values(item: pytest.Item) -> set[tuple[int, str]]:
    """By their names, which its own name has side by side."""
    return set(enumerate(item.nodeid.partition("[")[2].removesuffix("]").split("-")))
