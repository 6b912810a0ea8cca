"""How many examples are drawn: an eighth of those a test asks for, and all by `pytest --whole`.

In CI the same ones are drawn each time; whoever runs a test by hand draws others.
"""

from dataclasses import dataclass

from hypothesis import settings

_FEWEST = 5


@dataclass
class _Share:
    divisor: int = 8


_SHARE = _Share()


def draw_all() -> None:
    """From now on as many as are asked for: before tests are imported."""
    _SHARE.divisor = 1


def drawn(examples: int) -> settings:
    """The settings of a property for which so many are drawn, however slow they are."""
    count = max(min(examples, _FEWEST), examples // _SHARE.divisor)
    return settings(deadline=None, max_examples=count)
