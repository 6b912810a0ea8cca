"""The last step of a run that stays in the range of its number system."""

from collections.abc import Callable, Sequence

from verify.lockstep import Course


def last_good(count: int, advance: Callable[[int], Course[Sequence[object]]]) -> Course[int]:
    """Return the greatest number of steps below `count` that stay in range, by bisection.
    `advance(n)` returns no states if one of n steps leaves the range, as one of `count` does."""
    # Raising the count never brings an orbit back into range, so the property is monotonic.
    good, bad = 0, count
    while bad - good > 1:
        middle = (good + bad) // 2
        if (yield from advance(middle)):
            good = middle
        else:
            bad = middle
    return good
