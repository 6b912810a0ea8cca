"""Observables of a function I of the state along a run: I − I₀ at the end, and max |I − I₀|.

At the end I is evaluated once, outside of the loop. The loop keeps the least and the greatest I of
the states before each step, where its parts are shared with those of the step.
"""

from typing import Any

from verify.observables.observable import Observable, never


def change_at_end(name: str, label: str, tex: str, integral: str, **more: Any) -> Observable:
    """Return the observable I − I₀ after the last step."""
    return Observable(
        name,
        label,
        tex,
        needs=None,
        lines=lambda loop: [],
        carried="",
        integral=integral,
        at_end=True,
        bound=lambda at: at.bound_of_change(integral),
        plotted=f"|{label}|",
        **{"vanishes": never, **more},
    )


def greatest_change(name: str, label: str, tex: str, integral: str, **more: Any) -> Observable:
    """Return the observable max |I − I₀| over the states of the run."""
    return Observable(
        name,
        label,
        tex,
        needs=None,
        lines=lambda loop: loop.extremes(integral),
        carried="",
        integral=integral,
        bound=lambda at: at.bound_of_greatest_change(integral),
        **{"vanishes": never, **more},
    )
