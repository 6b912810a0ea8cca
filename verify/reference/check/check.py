"""A folder of reference data against itself, its manifest and its schemas; and some of it again.

What cannot be read is an InputError. What can be read and is not as it must be is a difference.
"""

import math
import random
import re
import shlex
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from verify.errors import InputError
from verify.execution.executors import (
    ANYWHERE,
    THIS_PROCESS,
    FunctionCall,
    Placement,
    open_place,
    results_of,
)
from verify.execution.machine import versions
from verify.files import MOST_BYTES, read_bytes, text_of
from verify.formats import check_format
from verify.reference.check import consistency
from verify.reference.check.difference import Findings, Place
from verify.reference.check.recompute import recomputed
from verify.reference.make.models import (
    MANIFEST_FORMAT,
    MODELS,
    AnyData,
    Manifest,
    format_at,
    format_of,
)
from verify.reference.make.reading import json_of, rows_of
from verify.reference.make.scene_plan import size_of
from verify.reference.make.writing import (
    MANIFEST,
    SCHEMAS,
    digest,
    json_text,
    listed,
    names_of,
    schema_text,
    tables,
)
from verify.scenes.scene import Scene, scene_from_toml

M = TypeVar("M", bound=BaseModel)
Unit = tuple[AnyData, str, str, int]  # what `recomputed` takes
_MOST_BYTES_OF_ALL = 8 * MOST_BYTES  # of the files that are listed; they are held in memory
_WORTH_A_POOL = 150  # recomputations, below which starting workers costs more than it gains
_VERSION = re.compile(r"[0-9]+(\.[0-9a-z+]+)*")
_NO_MORE = ("numba",)  # what data may name that were made with it, and is not used any more


@dataclass
class Checked(Findings):
    """What a check found. `rows`: of all data; `not_compared`: files, each with the reason."""

    files: int = 0
    rows: int = 0
    seed: int = 0
    not_compared: list[str] = field(default_factory=list)


def check(
    folder: Path,
    *,
    share: float,
    seed: int,
    own: Path | None = None,
    most_steps: int | None = None,
    where: Placement = ANYWHERE,
    done: Callable[[int, int], None] | None = None,
) -> Checked:
    """Everything of the folder by itself, and a random share of its data computed again.

    `share`: from 0 to 1, of all runs, flows and proofs; `seed` chooses which.
    `own`: the folder of the scenes that it must have been made from, where that is known.
    `most_steps`: how many are done again at most; the runs that want more are named. `done`
    is called with how many recomputations are finished, of how many. InputError where a file cannot
    be read: it is missing, too large, of another format or version, no UTF-8, no JSON, no CSV.
    """
    found = Checked(seed=seed)
    units = []
    for data, file in _by_itself(folder, own, found):
        found.rows += data.count
        kinds = ("proof", data.proofs), ("run", data.runs), ("flow", data.flow)
        units += [(data, file, kind, k) for kind, items in kinds for k in range(len(items))]
    if found.differences:  # what is asked for may not even be known
        return found
    chosen = _affordable(_chosen(units, share, seed), most_steps, found)
    calls = [FunctionCall(str(k), recomputed, unit) for k, unit in enumerate(chosen)]
    parts: dict[str, Findings] = {}
    few = where == ANYWHERE and len(calls) < _WORTH_A_POOL
    with open_place(THIS_PROCESS if few else where, [recomputed.__module__]) as place:
        for name, part in results_of(place, calls):
            parts[name] = part
            if done:
                done(len(parts), len(calls))
    for call in calls:  # in the order of the files, whoever was first
        found.add(parts[call.name])
    return found


def _chosen(units: Sequence[Unit], share: float, seed: int) -> list[Unit]:
    """A share of the units, at least one where it is not 0, in their order."""
    count = min(len(units), math.ceil(share * len(units)))
    chosen = random.Random(seed).sample(range(len(units)), count)  # noqa: S311 - no secret
    return [units[k] for k in sorted(chosen)]


def _affordable(units: Sequence[Unit], most_steps: int | None, found: Checked) -> list[Unit]:
    """The units without the runs that would make more steps than that, which are named."""
    left, kept = most_steps, []
    for unit in units:
        data, file, kind, index = unit
        if left is not None and kind == "run":
            run = data.runs[index]
            steps = run.rows[-1].step
            if steps > left:
                why = f"with it, more than {most_steps} steps; see --most-steps"
                Place(found, file, f"{run.label}, step {steps}").is_left_out(why)
                continue
            left -= steps
        kept.append(unit)
    return kept


# -- by itself ------------------------------------------------------------------------------------


def _by_itself(folder: Path, own: Path | None, found: Checked) -> Iterator[tuple[AnyData, str]]:
    if not folder.is_dir():
        raise InputError(
            "DIR", str(folder), "is no folder; give one that `verify reference make` wrote"
        )
    manifest = _model(Manifest, MANIFEST_FORMAT, read_bytes(folder / MANIFEST), MANIFEST, found)
    if manifest is None:
        return
    contents: dict[str, bytes] = {}
    for name in _listed(folder, manifest, found):
        contents[name] = read_bytes(folder / name)
        if sum(map(len, contents.values())) > _MOST_BYTES_OF_ALL:
            raise InputError("DIR", str(folder), f"has more than {_MOST_BYTES_OF_ALL} bytes")
    read: dict[str, AnyData | None] = {}
    for name, content in contents.items():  # all are read before one is held against another
        if name.endswith(".json") and name not in SCHEMAS:
            form = format_at(folder / name)
            read[name] = _model(MODELS[form], form, content, name, found)
        elif name.endswith(".csv"):
            rows_of(content, name)
    for each in manifest.files:
        if each.name in contents:
            there = listed(each.name, contents[each.name])
            for column in ("bytes", "sha256"):
                said, is_so = str(getattr(each, column)), str(getattr(there, column))
                place = Place(found, each.name)
                place.must(said == is_so, column, f"{said} (manifest)", is_so)
    for name in SCHEMAS.keys() & contents.keys():
        text = text_of(contents[name], name)
        consistency.of_text(schema_text(name), text, Place(found, name))
    scenes = _scenes(manifest, own, found)
    _check_provenance(manifest, scenes, found)
    _complete(manifest, scenes, found)
    for name, scene in scenes.items():
        data = read.get(f"{name}.json")
        if data is not None:
            yield from _of_scene(data, f"{name}.json", scene, contents, found)


def _of_scene(
    data: AnyData, file: str, scene: Scene, contents: dict[str, bytes], found: Checked
) -> Iterator[tuple[AnyData, str]]:
    consistency.of_data(data, scene, Place(found, file))
    for name, rows in tables(data).items():
        content = contents.get(f"{name}.csv")
        if content is not None:
            consistency.of_csv(rows, content, Place(found, f"{name}.csv"))
        content = contents.get(f"{name}.parquet")
        if content is not None:
            from verify.reference.make.parquet import installed, parquet_rows

            if installed():
                again = parquet_rows(content, f"{name}.parquet")
                consistency.of_table(rows, again, Place(found, f"{name}.parquet"))
            else:
                found.not_compared.append(f"{name}.parquet: pyarrow is not installed")
    yield data, file


def _model(model: type[M], form: str, content: bytes, name: str, found: Checked) -> M | None:
    """The model in a file; None, and a difference, where it is not as the schema says."""
    raw = check_format(json_of(content, name), form, name)
    try:
        made = model.model_validate(raw)
    except ValidationError as error:
        told = error.errors(include_url=False)[0]
        where, what = ".".join(map(str, told["loc"])), f"as the schema says ({told['msg']})"
        Place(found, name, where).differs("", what, str(told["input"]))
        return None
    consistency.of_text(json_text(made), text_of(content, name), Place(found, name))
    return made


def _listed(folder: Path, manifest: Manifest, found: Checked) -> Iterator[str]:
    """The files that are listed and there; the others are differences."""
    there = {path.name for path in folder.iterdir()} - {MANIFEST}
    names = [each.name for each in manifest.files]
    for name in sorted({*there, *names}):
        if name not in there:
            Place(found, name).differs("", "a file", "missing")
        elif name not in names:
            Place(found, name).differs("", "in the manifest, or not there", "extra")
        elif names.count(name) > 1:
            Place(found, MANIFEST, name).differs("", "listed once", "listed twice")
        else:
            found.files += 1
            yield name


def _scenes(manifest: Manifest, own: Path | None, found: Checked) -> dict[str, Scene]:
    """The manifest's scenes by name, each from its own text."""
    scenes = {}
    for each in manifest.scenes:
        place = Place(found, MANIFEST, f"scene {each.name}")
        actual = digest(each.toml.encode())
        place.must(each.sha256 == actual, "sha256", actual, each.sha256)
        try:
            scene = scene_from_toml(each.toml, each.name)
        except InputError as error:
            place.differs("toml", "a scene", str(error))
            continue
        if size_of(scene) > MOST_BYTES:  # what it asks for is listed, and would fill all memory
            place.differs("toml", "a scene whose data can be read", each.toml)
            continue
        scenes[each.name] = scene
    if own is not None:
        wanted = {path.stem: path.read_text(encoding="utf-8") for path in own.glob("*.toml")}
        given = {each.name: each.toml for each in manifest.scenes}
        for name in sorted({*wanted, *given}):
            mine, theirs = wanted.get(name, ""), given.get(name, "")
            consistency.of_text(mine, theirs, Place(found, f"{MANIFEST}: scene {name}"))
    return scenes


def _check_provenance(manifest: Manifest, scenes: dict[str, Scene], found: Checked) -> None:
    """The command and the versions, as far as they can be told to be wrong."""
    wanted = _other_command(manifest, scenes)
    if wanted is not None:
        Place(found, MANIFEST, "command").differs("", wanted, manifest.command)
    place = Place(found, MANIFEST, "versions")
    given = [name for name in manifest.versions if name not in _NO_MORE]
    place.must(given == list(versions()), "", ", ".join(versions()), ", ".join(given))
    for name, version in manifest.versions.items():
        place.must(_VERSION.fullmatch(version), name, "a version", version)


def _other_command(manifest: Manifest, scenes: dict[str, Scene]) -> str | None:
    """What should stand there for the command; None where that may have made the files."""
    try:
        words = shlex.split(manifest.command)
    except ValueError:
        words = []
    files = [x for x in words[3:] if x != "--parquet"]
    if words[:3] != ["verify", "reference", "make"] or not all(x.endswith(".toml") for x in files):
        return "verify reference make, and scenes"
    if files and len(scenes) == len(manifest.scenes):
        for file, each in zip_longest(files, manifest.scenes):
            stem = (file or "").removesuffix(".toml")
            if each is None or scene_from_toml(each.toml, stem).name != each.name:
                return " ".join(f"{name}.toml" for name in scenes)
    return None


def _complete(manifest: Manifest, scenes: dict[str, Scene], found: Checked) -> None:
    """Whether each scene has its files, and each file its scene."""
    formats = {name: format_of(x.exact_hamiltonian().degrees) for name, x in scenes.items()}
    wanted = names_of(formats, parquet="--parquet" in manifest.command.split())
    names = [each.name for each in manifest.files]
    one_each = len(scenes) == len(manifest.scenes)
    Place(found, MANIFEST, "scenes").must(one_each, "", "one of each name", "two")
    files = Place(found, MANIFEST, "files")
    for name in sorted(wanted ^ set(names)):
        given = ("listed", "not listed") if name in wanted else ("not listed", "listed")
        files.differs(name, *given)
    files.must(names == sorted(names), "", "in the order of names", "not")
