"""A splitting of a field without an H: `A 1/2; B 1; A 1/2 with A: x_dot = y; B: y_dot = -sin(x)`.

Sizes are numbers, in parts of h. The parts add up to the field, and the flow of each is a
polynomial in time; see `verify.schemes.field_splitting`. It claims consistency (order 1) and
nothing else.
"""

from collections.abc import Mapping
from functools import partial

from verify.errors import InputError
from verify.hamiltonians.equations import Equations
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.splitting_conditions import LETTERS
from verify.schemes.field_splitting import add_parts, has_steps, separate_parts, splitting_map
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme

EXAMPLES = ()  # names are texts that users write


def make(name: str) -> Scheme | None:
    """Return the scheme for a text with parts; None for another text. InputError for a bad one."""
    steps, parts = separate_parts(name)
    if not parts:
        # Those of an H are kick and drift; a single step may be a mistyped name, as `lie 2`.
        if ";" in name and has_steps(name) and name.split()[0].lower() not in LETTERS:
            problem = "has no parts: write --split, in a scene [[split]], or A 1 with A: x_dot = …"
            raise InputError("scheme", name, problem)
        return None
    add_parts(steps, parts)  # raises InputError
    build = partial(_build, steps, parts)
    return Scheme(name, order=1, source="the user's splitting", build=build, takes_equations=True)


def _build(steps: str, parts: Mapping[str, str], system: Hamiltonian) -> StepMap:
    if not isinstance(system, Equations):
        problem = "are parts of equations without an H; for an H write kick 1/2; drift 1; kick 1/2"
        raise InputError("split", ", ".join(parts), problem)
    return splitting_map(system, steps, parts)
