"""How many examples are drawn: as many as a test asks for, and an eighth of them in CI.

There the same ones are drawn each time, so that more of them would find something once and never
again; whoever runs a test by hand draws others.
"""

import os

from hypothesis import settings

_FEWEST = 5
_SHARE = 8 if os.environ.get("CI") else 1


def drawn(examples: int) -> settings:
    """The settings of a property for which so many are drawn, however slow they are."""
    count = max(min(examples, _FEWEST), examples // _SHARE)
    return settings(deadline=None, max_examples=count)
