"""A check of a folder of reference data against its manifest, its schemas and its scenes; a share
of the data is computed again.

A file that cannot be read is an InputError. One that can be read and is not as it must be is a
difference.
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
from verify.reference.check.difference import DataFindings, DataPlace
from verify.reference.check.recompute import recompute_unit
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
    describe_file,
    digest,
    json_text,
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
class CheckResult(DataFindings):
    """The result of a check. `rows` counts those of all data; `not_compared` names files, each with
    the reason."""

    files: int = 0
    rows: int = 0
    seed: int = 0
    not_compared: list[str] = field(default_factory=list)


def check(
    folder: Path,
    *,
    share: float,
    seed: int,
    scenes_folder: Path | None = None,
    most_steps: int | None = None,
    where: Placement = ANYWHERE,
    done: Callable[[int, int], None] | None = None,
) -> CheckResult:
    """Check all files of the folder, and compute a random share of its data again.

    `share`: from 0 to 1, of all runs, flows and proofs; `seed` chooses which. `scenes_folder`: the
    folder of the scenes that the data must have been made from, if it exists. `most_steps`: how
    many steps are computed again at most; runs that need more are named. `done` is called with the
    number of finished recomputations and the number of all. Raises InputError where a file cannot
    be read: it is missing, too large, of another format or version, not UTF-8, not JSON or not CSV.
    """
    findings = CheckResult(seed=seed)
    units = []
    for data, file in _check_files(folder, scenes_folder, findings):
        findings.rows += data.count
        kinds = ("proof", data.proofs), ("run", data.runs), ("flow", data.flow)
        units += [(data, file, kind, k) for kind, items in kinds for k in range(len(items))]
    # Recomputing from inconsistent files would only repeat their errors in another form.
    if findings.differences:  # what is asked for may not even be known
        return findings
    chosen = _select_affordable(_choose(units, share, seed), most_steps, findings)
    calls = [FunctionCall(str(k), recompute_unit, unit) for k, unit in enumerate(chosen)]
    parts: dict[str, DataFindings] = {}
    serial = where == ANYWHERE and len(calls) < _WORTH_A_POOL
    with open_place(THIS_PROCESS if serial else where, [recompute_unit.__module__]) as place:
        for name, part in results_of(place, calls):
            parts[name] = part
            if done:
                done(len(parts), len(calls))
    # Workers finish in any order; the report must not depend on it.
    for call in calls:  # in the order of the files, whoever was first
        findings.add(parts[call.name])
    return findings


def _choose(units: Sequence[Unit], share: float, seed: int) -> list[Unit]:
    """Choose a share of the units, at least one where it is not 0, and keep their order."""
    # The seed is reported, so that a failing sample can be drawn again.
    count = min(len(units), math.ceil(share * len(units)))
    chosen = random.Random(seed).sample(range(len(units)), count)  # noqa: S311 - no secret
    return [units[k] for k in sorted(chosen)]


def _select_affordable(
    units: Sequence[Unit], most_steps: int | None, findings: CheckResult
) -> list[Unit]:
    """Return the units without the runs that exceed the limit of steps; these are named in the
    findings."""
    steps_left, selected = most_steps, []
    for unit in units:
        data, file, kind, index = unit
        if steps_left is not None and kind == "run":
            run = data.runs[index]
            steps = run.rows[-1].step
            if steps > steps_left:
                why = f"with it, more than {most_steps} steps; see --most-steps"
                DataPlace(findings, file, f"{run.label}, step {steps}").is_left_out(why)
                continue
            steps_left -= steps
        selected.append(unit)
    return selected


# -- by itself ------------------------------------------------------------------------------------


def _check_files(
    folder: Path, scenes_folder: Path | None, findings: CheckResult
) -> Iterator[tuple[AnyData, str]]:
    if not folder.is_dir():
        raise InputError(
            "DIR", str(folder), "is no folder; give one that `verify reference make` wrote"
        )
    manifest = _parse_model(
        Manifest, MANIFEST_FORMAT, read_bytes(folder / MANIFEST), MANIFEST, findings
    )
    if manifest is None:
        return
    contents: dict[str, bytes] = {}
    for name in _list_present_files(folder, manifest, findings):
        contents[name] = read_bytes(folder / name)
        if sum(map(len, contents.values())) > _MOST_BYTES_OF_ALL:
            # The sum is checked after every file, so that a folder of many files cannot exhaust the
            # memory.
            raise InputError("DIR", str(folder), f"has more than {_MOST_BYTES_OF_ALL} bytes")
    data_by_file: dict[str, AnyData | None] = {}
    for name, content in contents.items():  # all are read before one is held against another
        if name.endswith(".json") and name not in SCHEMAS:
            form = format_at(folder / name)
            data_by_file[name] = _parse_model(MODELS[form], form, content, name, findings)
        elif name.endswith(".csv"):
            rows_of(content, name)
    for each in manifest.files:
        if each.name in contents:
            actual = describe_file(each.name, contents[each.name])
            for column in ("bytes", "sha256"):
                stated, actual_value = str(getattr(each, column)), str(getattr(actual, column))
                place = DataPlace(findings, each.name)
                place.require(stated == actual_value, column, f"{stated} (manifest)", actual_value)
    for name in SCHEMAS.keys() & contents.keys():
        text = text_of(contents[name], name)
        consistency.compare_texts(schema_text(name), text, DataPlace(findings, name))
    scenes = _read_scenes(manifest, scenes_folder, findings)
    _check_provenance(manifest, scenes, findings)
    _check_completeness(manifest, scenes, findings)
    for name, scene in scenes.items():
        data = data_by_file.get(f"{name}.json")
        if data is not None:
            yield from _check_scene(data, f"{name}.json", scene, contents, findings)


def _check_scene(
    data: AnyData, file: str, scene: Scene, contents: dict[str, bytes], findings: CheckResult
) -> Iterator[tuple[AnyData, str]]:
    consistency.check_data(data, scene, DataPlace(findings, file))
    for name, rows in tables(data).items():
        content = contents.get(f"{name}.csv")
        if content is not None:
            consistency.compare_csv(rows, content, DataPlace(findings, f"{name}.csv"))
        content = contents.get(f"{name}.parquet")
        if content is not None:
            from verify.reference.make.parquet import is_installed, parquet_rows

            if is_installed():
                parquet_table = parquet_rows(content, f"{name}.parquet")
                consistency.compare_tables(
                    rows, parquet_table, DataPlace(findings, f"{name}.parquet")
                )
            else:
                findings.not_compared.append(f"{name}.parquet: pyarrow is not installed")
    yield data, file


def _parse_model(
    model: type[M], form: str, content: bytes, name: str, findings: CheckResult
) -> M | None:
    """Return the model in a file; None, with a difference, where the content violates the
    schema."""
    raw = check_format(json_of(content, name), form, name)
    try:
        parsed = model.model_validate(raw)
    except ValidationError as error:
        first_error = error.errors(include_url=False)[0]
        where = ".".join(map(str, first_error["loc"]))
        what = f"as the schema says ({first_error['msg']})"
        DataPlace(findings, name, where).differs("", what, str(first_error["input"]))
        return None
    consistency.compare_texts(json_text(parsed), text_of(content, name), DataPlace(findings, name))
    return parsed


def _list_present_files(folder: Path, manifest: Manifest, findings: CheckResult) -> Iterator[str]:
    """Yield the files that are listed and present; all others are differences."""
    present = {path.name for path in folder.iterdir()} - {MANIFEST}
    names = [each.name for each in manifest.files]
    for name in sorted({*present, *names}):
        if name not in present:
            DataPlace(findings, name).differs("", "a file", "missing")
        elif name not in names:
            DataPlace(findings, name).differs("", "in the manifest, or not there", "extra")
        elif names.count(name) > 1:
            DataPlace(findings, MANIFEST, name).differs("", "listed once", "listed twice")
        else:
            findings.files += 1
            yield name


def _read_scenes(
    manifest: Manifest, scenes_folder: Path | None, findings: CheckResult
) -> dict[str, Scene]:
    """Return the manifest's scenes by name, each read from its own text."""
    scenes = {}
    for each in manifest.scenes:
        place = DataPlace(findings, MANIFEST, f"scene {each.name}")
        actual = digest(each.toml.encode())
        place.require(each.sha256 == actual, "sha256", actual, each.sha256)
        try:
            scene = scene_from_toml(each.toml, each.name)
        except InputError as error:
            place.differs("toml", "a scene", str(error))
            continue
        if size_of(scene) > MOST_BYTES:  # what it asks for is listed, and would fill all memory
            place.differs("toml", "a scene whose data can be read", each.toml)
            continue
        scenes[each.name] = scene
    if scenes_folder is not None:
        expected_scenes = {
            path.stem: path.read_text(encoding="utf-8") for path in scenes_folder.glob("*.toml")
        }
        manifest_scenes = {each.name: each.toml for each in manifest.scenes}
        for name in sorted({*expected_scenes, *manifest_scenes}):
            mine, theirs = expected_scenes.get(name, ""), manifest_scenes.get(name, "")
            consistency.compare_texts(
                mine, theirs, DataPlace(findings, f"{MANIFEST}: scene {name}")
            )
    return scenes


def _check_provenance(manifest: Manifest, scenes: dict[str, Scene], findings: CheckResult) -> None:
    """Check the command and the versions, as far as they can be shown to be wrong."""
    expected = _expected_command(manifest, scenes)
    if expected is not None:
        DataPlace(findings, MANIFEST, "command").differs("", expected, manifest.command)
    place = DataPlace(findings, MANIFEST, "versions")
    names = [name for name in manifest.versions if name not in _NO_MORE]
    place.require(names == list(versions()), "", ", ".join(versions()), ", ".join(names))
    for name, version in manifest.versions.items():
        place.require(_VERSION.fullmatch(version), name, "a version", version)


def _expected_command(manifest: Manifest, scenes: dict[str, Scene]) -> str | None:
    """Return the command that should be named; None where the one named may have made the files."""
    try:
        words = shlex.split(manifest.command)
    except ValueError:
        words = []
    files = [x for x in words[3:] if x != "--parquet"]
    if words[:3] != ["verify", "reference", "make"] or not all(x.endswith(".toml") for x in files):
        return "verify reference make, and scenes"
    # The command names files in the order of the scenes; a path before the name is not compared,
    # since the data may have been made in another folder.
    if files and len(scenes) == len(manifest.scenes):
        for file, each in zip_longest(files, manifest.scenes):
            stem = (file or "").removesuffix(".toml")
            if each is None or scene_from_toml(each.toml, stem).name != each.name:
                return " ".join(f"{name}.toml" for name in scenes)
    return None


def _check_completeness(
    manifest: Manifest, scenes: dict[str, Scene], findings: CheckResult
) -> None:
    """Check that each scene has its files, and each file its scene."""
    formats = {name: format_of(x.exact_hamiltonian().degrees) for name, x in scenes.items()}
    expected = names_of(formats, parquet="--parquet" in manifest.command.split())
    names = [each.name for each in manifest.files]
    one_each = len(scenes) == len(manifest.scenes)
    DataPlace(findings, MANIFEST, "scenes").require(one_each, "", "one of each name", "two")
    files = DataPlace(findings, MANIFEST, "files")
    for name in sorted(expected ^ set(names)):
        states = ("listed", "not listed") if name in expected else ("not listed", "listed")
        files.differs(name, *states)
    files.require(names == sorted(names), "", "in the order of names", "not")
