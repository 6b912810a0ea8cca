"""A structure that a step may keep: how its defect is called, measured and told."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Structure:
    """`state`: how a point is called; `defect`: what one step misses it by; `accumulated`: what N
    steps do, and `size`: how large that is.

    `zero`: what the defect is where it vanishes; `vanishes` says so, `identity` in short, and
    `claim` is what a scheme claims that says so. `of_step`, `of_run`, `over_run`: the observables
    of a run that are the defect's greatest size, what has accumulated, and the most that it was.
    """

    name: str
    state: str
    defect: str
    accumulated: str
    size: str
    zero: str
    vanishes: str
    identity: str
    claim: str
    of_step: str
    of_run: str
    over_run: str
