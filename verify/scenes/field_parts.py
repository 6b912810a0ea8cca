"""Scenes of equations without an H: the parts of their splittings, and the sections that they take.

field = "v_dot = -sin(x); x_dot = v"
schemes = ["kick 1/2; drift 1; kick 1/2", "rk4"]

[[split]]                              # a part, whose flow is a polynomial in time
name = "kick"
field = "v_dot = -sin(x)"

[[split]]
name = "drift"
field = "x_dot = v"
"""

from collections.abc import Sequence

from verify.errors import InputError
from verify.hamiltonians.equations import EXAMPLE, are_equations
from verify.scenes.frozen import Frozen
from verify.scenes.run_sections import Grid
from verify.schemes.field_splitting import add_parts, has_steps, separate_parts


class FieldPart(Frozen):
    """A part of a splitting of the field, which flows exactly; the parts add up to the field."""

    name: str
    """Its name in schemes such as `kick 1/2; drift 1; kick 1/2`: letters, digits and _."""
    field: str
    """Its equations; a coordinate that it does not move may be left out."""


def with_field_parts(scheme: str, parts: Sequence[FieldPart]) -> str:
    """Return a scheme with the parts of which it is composed, and any other scheme as it is.

    Raises InputError for a name that stands twice.
    """
    fields = {part.name: part.field for part in parts}
    if len(fields) < len(parts):
        raise InputError("split", len(parts), "a name stands twice; each part has its own")
    return add_parts(scheme, fields) if fields and has_steps(scheme) else scheme


def add_field_parts(schemes: Sequence[str], parts: Sequence[FieldPart]) -> tuple[str, ...]:
    """Return the schemes as `with_field_parts` does; InputError for parts that none is made of."""
    texts = tuple(with_field_parts(scheme, parts) for scheme in schemes)
    if parts and not any(separate_parts(text)[1] for text in texts):
        names = [part.name for part in parts]
        problem = (
            f"no scheme is composed of its parts; write '{'; '.join(f'{n} 1' for n in names)}'"
        )
        raise InputError("split", ", ".join(names), problem)
    return texts


def check_field_scene(field: str, sections: dict[str, object]) -> None:
    """Raise InputError if a scene of equations has a section that takes an H.

    `sections`: what it asks for beside `keeps`, by the names of keys.
    """
    grid = sections.get("grid")
    keys = {name: value for name, value in sections.items() if name not in ("grid", "series")}
    if isinstance(grid, Grid):
        keys |= {f"grid.{name}": getattr(grid, name) for name in ("separate", "growth")}
    for name in (name for name, value in keys.items() if value):
        raise InputError("field", field, f"has no H; {name} takes one, in p and q")


def check_equations(field: str) -> None:
    """Raise InputError if a text has no equation."""
    if not are_equations(field):
        raise InputError("field", field, f"has no equation; write {EXAMPLE}")
