"""A structure that a step may preserve: the names and observables of its defect."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Structure:
    """A structure that a step may preserve: area, or the symplectic form.

    `state`: the name of a point; `defect`: by how much one step misses the structure;
    `accumulated`: the defect of N steps, and `size` its size.

    `zero`: the kind of object that the defect is where it vanishes; `vanishes` is the sentence that
    it does, `identity` the short form, and `claim` that of a scheme that claims it. `of_step`,
    `of_run`, `over_run`: the observables of a run for the greatest defect of a step, the
    accumulated defect, and its greatest value during the run.
    """

    # Both structures have the same fields, so that no caller has to ask for the plane.

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
