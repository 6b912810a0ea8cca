"""The scenes of claims: built from a claim's own Hamiltonian and runs, or looked up by name.

One of the keys `scene`, `system`, `hamiltonian` and `every`, with `parameters`, selects H, and
`field` equations without an H, with the parts of a `split`; see `verify.claims.run_claims` for the
keys of runs.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from pydantic import Field

from verify.claims.base_claim import Claim
from verify.errors import NOT_GIVEN, InputError
from verify.scenes.field_parts import FieldPart, with_field_parts
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene, load_scene, scene_from
from verify.scenes.toml_file import Lines, tables_of
from verify.scenes.values import ExactNumber, SystemName

HAMILTONIAN_SOURCES = ("scene", "system", "hamiltonian", "field", "every")
HAMILTONIAN_KEYS = (*HAMILTONIAN_SOURCES, "parameters", "t0", "split")


class ClaimedHamiltonian(Frozen):
    """The keys that define H, or a field; `parameters` belong to them."""

    system: SystemName | None = None
    """A named system."""
    hamiltonian: str | None = None
    """H as a formula in p, q and parameters."""
    field: str | None = None
    """Equations without an H, as `u_dot = u*(v - 2); v_dot = v*(1 - u)`, for a claim of kind
    `keeps`."""
    parameters: dict[str, ExactNumber] = Field(default_factory=dict)
    """The values of H's parameters; those without one stay symbols."""
    t0: ExactNumber = Fraction(0)
    """When its runs start, if H depends on t."""
    split: tuple[FieldPart, ...] = ()
    """The parts of a splitting of `field`, of which the scheme is composed, as in a scene."""


def scene_for(
    claim: Claim,
    hamiltonian_keys: Mapping[str, Any],
    runs: Mapping[str, Any],
    find_scene: Callable[[str], Scene],
) -> tuple[Claim, Scene]:
    """Return the claim with the unique name of its scene, and the scene.

    `hamiltonian_keys` and `runs`: the claim's keys of H and of its runs; `find_scene` returns a
    scene by its name. Raises pydantic's ValidationError, and InputError, whose name is the key,
    also if the claim's kind does not admit this H.
    """
    sources = [name for name in HAMILTONIAN_SOURCES if name in hamiltonian_keys]
    if len(sources) != 1:
        problem = f"give one of {', '.join(HAMILTONIAN_SOURCES)}"
        raise InputError(" and ".join(sources) or "scene", NOT_GIVEN, problem)
    if "scene" not in hamiltonian_keys:
        hamiltonian = ClaimedHamiltonian.model_validate(hamiltonian_keys)
        claim = _with_parts(claim, hamiltonian.split)
        keys = hamiltonian.model_dump(exclude={"split"})
        scene = Scene(**keys, schemes=(claim.scheme,), name=slug(claim.id))
        if hamiltonian.split and scene.field is None:
            raise InputError("split", hamiltonian.split[0].name, "goes with field")
        _check_field(claim, scene)
        name, scene = claim.separate_scene(hamiltonian.system or "own", scene, runs)
    else:
        for key in ("parameters", "t0", "split"):
            if key in hamiltonian_keys:
                raise InputError(key, NOT_GIVEN, "stands in the scene's own file")
        name = hamiltonian_keys["scene"]
        scene = find_scene(name)
        _check_field(claim, scene)
        claim = _with_parts(claim, scene.split)
        name, scene = claim.selected_scene(name, scene, runs)
    _check_hamiltonian(claim, scene)
    return claim.model_copy(update={"scene": name}), scene


def _with_parts(claim: Claim, parts: Sequence[FieldPart]) -> Claim:
    return claim.model_copy(update={"scheme": with_field_parts(claim.scheme, parts)})


def _check_field(claim: Claim, scene: Scene) -> None:
    """Raise InputError if the scene is of equations without an H, and the claim's kind is not."""
    if scene.field is not None and not claim.of_fields:
        problem = "is of an H; of equations without one speak claims of kind keeps"
        raise InputError("kind", claim.kind, problem)


def _check_hamiltonian(claim: Claim, scene: Scene) -> None:
    """Raise InputError if the claim's kind does not admit this H."""
    hamiltonian = scene.exact_hamiltonian()
    if claim.planar and not hamiltonian.planar:
        problem = f"is of one degree of freedom; the H that it speaks of has {hamiltonian.degrees}"
        raise InputError("kind", claim.kind, problem)
    if claim.autonomous and hamiltonian.time_dependent:
        problem = "is of an H without t, and so of no H that depends on t"
        raise InputError("kind", claim.kind, problem)


def slug(name: str) -> str:
    """Replace by a dash each character that is not allowed in names of scenes and files.

    >>> slug("Eq. 21 (b)")
    'Eq--21--b-'
    """
    return "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in name)[:80]


class NamedScenes:
    """The scenes by name: the file's own `[[scene]]` tables, then the files in its folder."""

    def __init__(self, path: Path, tables: Any, lines: Lines) -> None:
        self.folder, self.scenes = path.parent, dict[str, Scene]()
        for index, table in enumerate(tables_of(path.name, "scene", tables)):
            place = f"{path.name}:{lines.line_of('scene', index)}: scene"
            name = table.get("name") if isinstance(table, dict) else None
            if not isinstance(name, str) or not name or name in self.scenes:
                raise InputError(place, name or NOT_GIVEN, "each [[scene]] has a name of its own")
            self.scenes[name] = scene_from(table, place)

    def get(self, name: Any) -> Scene:
        """Return the scene of that name; InputError if there is none, or it is no name."""
        # The names of scenes become parts of paths, so that no other characters are admitted.
        if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z0-9_-]{1,80}", name):
            raise InputError("scene", name, "is no name of a scene: letters, digits, _ and -")
        if name not in self.scenes:
            path = self.folder / f"{name}.toml"
            if not path.is_file():
                raise InputError("scene", name, f"there is no {name}.toml beside the claims file")
            self.scenes[name] = load_scene(path)
        return self.scenes[name]
