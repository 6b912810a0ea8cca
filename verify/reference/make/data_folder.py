"""Scenes → reference data: the plan's tasks, then one JSON file for a scene, its tables, a
manifest."""

import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from verify.content import content
from verify.errors import InputError
from verify.execution.provenance import versions
from verify.files import MOST_BYTES, read_text, write_atomically
from verify.formats import names_format
from verify.reference.make import models
from verify.reference.make.data_files import (
    MANIFEST,
    MANIFEST_FORMAT,
    Manifest,
    SceneFile,
    csv_text,
    describe_file,
    digest,
    json_text,
    names_of,
    schema_text,
    schemas_for,
    tables,
)
from verify.reference.make.scene_plan import orbit_tasks, proof_tasks, size_of, solution_tasks
from verify.scenes.results.proof_result import ProofResult
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.scene import Scene, load_scene

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,79}")
SCENES = content("reference", "scenes")
PUBLISHED = content("reference", "data")


@dataclass(frozen=True)
class SceneText:
    """A scene and the text that it was read from."""

    scene: Scene
    toml: str


def load(paths: Sequence[Path]) -> list[SceneText]:
    """Load the scenes in TOML files.

    Raises InputError for one that requests no reference data, a name that no file can have, or two
    of one name, of which one would overwrite the other.
    """
    scenes = [SceneText(load_scene(path), read_text(path)) for path in paths]
    for path, entry in zip(paths, scenes, strict=True):
        if not entry.scene.reference:
            raise InputError("SCENE", str(path), "asks for no [[reference]]")
        if (size := size_of(entry.scene)) > MOST_BYTES:
            problem = f"makes a file of about {size} bytes; allowed: {MOST_BYTES}"
            raise InputError("SCENE", str(path), problem)
    names = [entry.scene.name for entry in scenes]
    for name in names:
        if not _NAME.fullmatch(name) or f"{name}.json" == MANIFEST:
            problem = "cannot begin a file's name; allowed: letters, digits, - and _; not manifest"
            raise InputError("name", name, problem)
        if names.count(name) > 1:
            raise InputError("SCENE", name, "two scenes have this name")
    return scenes


def committed_scenes() -> list[Path]:
    """Return the paths of the scenes that the committed set is made from."""
    return sorted(SCENES.glob("*.toml"))


def data_of(scene: Scene, results: Mapping[str, Any]) -> models.AnyData:
    """Return a scene's data from the results of its tasks, by their keys."""
    hamiltonian = scene.exact_hamiltonian()
    form = models.format_of(hamiltonian.degrees)
    content = {
        "format": form,
        "name": scene.name,
        **models.heading(hamiltonian),
        "proofs": [_proof(task.scheme, results[task.key]) for task in proof_tasks(scene)],
        "runs": [
            {"scheme": task.scheme, **task.inputs, "rows": _rows(results[task.key])}
            for task in orbit_tasks(scene)
        ],
        "flow": [
            {**task.inputs, "rows": _rows(results[task.key])} for task in solution_tasks(scene)
        ],
    }
    return models.MODELS[form].model_validate(content)


def _rows(result: OrbitResult | SolutionResult) -> list[dict[str, Any]]:
    """Return the rows of a result, some of which may be of either format if they are read
    again."""
    return [point.model_dump() for point in result.points]


def _proof(scheme: str, result: ProofResult) -> dict[str, Any]:
    """Return a file's fields of a proof: of all entries of S in several degrees of freedom."""
    alike = ("verdict", "area_preserving", "order", "convergence_order")
    content = {"scheme": scheme, **{name: getattr(result, name) for name in alike}}
    form = result.form
    if form is None:
        return {"leading": result.leading, **content}
    return {"symplectic": form.symplectic, "leading": dict(form.entries), **content}


def check_is_alone(folder: Path, scenes: Sequence[SceneText], *, parquet: bool) -> None:
    """Raise InputError if the folder holds files that are not made again, and would be extra
    in a check, or a file of one of our names that is not ours."""
    # The check compares the folder with the list of its files: any other file would be a
    # difference.
    formats = {x.scene.name: models.format_of(x.scene.exact_hamiltonian().degrees) for x in scenes}
    names = {MANIFEST, *names_of(formats, parquet=parquet)}
    forms = {MANIFEST: MANIFEST_FORMAT, **{f"{name}.json": x for name, x in formats.items()}}
    present = {path.name: path for path in folder.iterdir()}
    foreign = sorted(present.keys() - names)
    foreign += [
        x for x, form in forms.items() if x in present and not names_format(present[x], form)
    ]
    if foreign:
        problem = (
            f"holds {foreign[0]!r}, which does not belong to these data; give a folder of its own"
        )
        raise InputError("--output", str(folder), problem)


def files_of(data: Sequence[models.AnyData], *, parquet: bool = False) -> dict[str, bytes]:
    """Return the content of all files but the manifest, by name."""
    schemas = schemas_for(scene_data.format for scene_data in data)
    files = {name: schema_text(name).encode() for name in schemas}
    for scene_data in data:
        files[f"{scene_data.name}.json"] = json_text(scene_data).encode()
        for name, rows in tables(scene_data).items():
            files[f"{name}.csv"] = csv_text(rows).encode()
            if parquet:
                from verify.reference.make.file_contents import parquet_bytes

                files[f"{name}.parquet"] = parquet_bytes(rows)
    return dict(sorted(files.items()))


def manifest_of(scenes: Sequence[SceneText], files: Mapping[str, bytes], command: str) -> Manifest:
    """Return the manifest of these files, with the versions that are installed."""
    return Manifest(
        format=MANIFEST_FORMAT,
        command=command,
        versions=versions(),
        scenes=tuple(
            SceneFile(name=x.scene.name, toml=x.toml, sha256=digest(x.toml.encode()))
            for x in scenes
        ),
        files=tuple(describe_file(name, raw) for name, raw in files.items()),
    )


def command_of(scenes: Sequence[str], parquet: bool) -> str:
    """Return the command that makes the same files again; without scenes, the committed set's are
    meant.

    >>> command_of(["somewhere/pendulum.toml"], parquet=True)
    'verify reference make pendulum.toml --parquet'
    """
    names = [shlex.quote(Path(name).name) for name in scenes]
    return " ".join(["verify reference make", *names, *(["--parquet"] if parquet else [])])


def write(folder: Path, files: Mapping[str, bytes], manifest: Manifest) -> None:
    """Write the files, each atomically, and the manifest last.

    An old manifest is removed first: an interruption leaves no manifest of other files behind.
    """
    # A folder without a manifest is refused by a check; one with a stale manifest might be
    # believed.
    (folder / MANIFEST).unlink(missing_ok=True)
    for name, raw in files.items():
        write_atomically(folder / name, raw)
    write_atomically(folder / MANIFEST, json_text(manifest))
