"""A check of a folder of reference data against its manifest, its schemas and its scenes; a share
of the data is computed again.

A file that cannot be read is an InputError. One that can be read and is not as it must be is a
difference.
"""

import math
import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from verify.errors import InputError
from verify.execution import executors
from verify.files import MOST_BYTES, read_bytes, text_of
from verify.formats import check_format
from verify.reference.check import data_rules
from verify.reference.check.difference import (
    DataFindings,
    DataPlace,
    compare_csv,
    compare_tables,
    compare_texts,
)
from verify.reference.check.recomputation import recompute_unit
from verify.reference.make import models
from verify.reference.make.data_files import (
    MANIFEST,
    MANIFEST_FORMAT,
    SCHEMAS,
    Manifest,
    describe_file,
    digest,
    json_text,
    schema_text,
    tables,
)
from verify.reference.make.file_contents import json_of, rows_of
from verify.reference.make.scene_plan import size_of
from verify.scenes.scene import Scene, scene_from_toml

M = TypeVar("M", bound=BaseModel)
Unit = tuple[models.AnyData, str, str, int]  # what `recomputed` takes
_MOST_BYTES_OF_ALL = 8 * MOST_BYTES  # of the files that are listed; they are held in memory
_WORTH_A_POOL = 150  # recomputations, below which starting workers costs more than it gains


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
    where: executors.Placement = executors.LOCAL_DEFAULT,
    done: Callable[[int, int], None] | None = None,
) -> CheckResult:
    """Check all files of the folder, and compute a random share of its data again.

    `share`: from 0 to 1, of all runs, flows and proofs; `seed` chooses which. `scenes_folder`: the
    folder of the scenes that the data must have been made from, if it exists. `most_steps`: how
    many steps are computed again at most; runs that need more are named. `done` is called with the
    number of finished recomputations and the number of all. Raises InputError if a file cannot
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
    calls = [executors.FunctionCall(str(k), recompute_unit, unit) for k, unit in enumerate(chosen)]
    parts: dict[str, DataFindings] = {}
    serial = where == executors.LOCAL_DEFAULT and len(calls) < _WORTH_A_POOL
    with executors.open_place(
        executors.THIS_PROCESS if serial else where, [recompute_unit.__module__]
    ) as place:
        for name, part in executors.results_of(place, calls):
            parts[name] = part
            if done:
                done(len(parts), len(calls))
    # Workers finish in any order; the report must not depend on it.
    for call in calls:  # in the order of the files, whoever was first
        findings.add(parts[call.name])
    return findings


def _choose(units: Sequence[Unit], share: float, seed: int) -> list[Unit]:
    """Choose a share of the units, at least one if it is not 0, and keep their order."""
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
                reason = f"with it, more than {most_steps} steps; see --most-steps"
                DataPlace(findings, file, f"{run.label}, step {steps}").is_left_out(reason)
                continue
            steps_left -= steps
        selected.append(unit)
    return selected


# -- by itself ------------------------------------------------------------------------------------


def _check_files(
    folder: Path, scenes_folder: Path | None, findings: CheckResult
) -> Iterator[tuple[models.AnyData, str]]:
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
    data_by_file: dict[str, models.AnyData | None] = {}
    for name, content in contents.items():  # all are read before one is held against another
        if name.endswith(".json") and name not in SCHEMAS:
            form = models.format_at(folder / name)
            data_by_file[name] = _parse_model(models.MODELS[form], form, content, name, findings)
        elif name.endswith(".csv"):
            rows_of(content, name)
    for listed in manifest.files:
        if listed.name in contents:
            actual = describe_file(listed.name, contents[listed.name])
            for column in ("bytes", "sha256"):
                stated, actual_value = str(getattr(listed, column)), str(getattr(actual, column))
                place = DataPlace(findings, listed.name)
                place.require(stated == actual_value, column, f"{stated} (manifest)", actual_value)
    for name in SCHEMAS.keys() & contents.keys():
        text = text_of(contents[name], name)
        compare_texts(schema_text(name), text, DataPlace(findings, name))
    scenes = _read_scenes(manifest, scenes_folder, findings)
    data_rules.check_provenance(manifest, scenes, findings)
    data_rules.check_completeness(manifest, scenes, findings)
    for name, scene in scenes.items():
        data = data_by_file.get(f"{name}.json")
        if data is not None:
            yield from _check_scene(data, f"{name}.json", scene, contents, findings)


def _check_scene(
    data: models.AnyData, file: str, scene: Scene, contents: dict[str, bytes], findings: CheckResult
) -> Iterator[tuple[models.AnyData, str]]:
    data_rules.check_data(data, scene, DataPlace(findings, file))
    for name, rows in tables(data).items():
        content = contents.get(f"{name}.csv")
        if content is not None:
            compare_csv(rows, content, DataPlace(findings, f"{name}.csv"))
        content = contents.get(f"{name}.parquet")
        if content is not None:
            from verify.reference.make.file_contents import has_pyarrow, parquet_rows

            if has_pyarrow():
                parquet_table = parquet_rows(content, f"{name}.parquet")
                compare_tables(rows, parquet_table, DataPlace(findings, f"{name}.parquet"))
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
        location = ".".join(map(str, first_error["loc"]))
        expectation = f"as the schema says ({first_error['msg']})"
        DataPlace(findings, name, location).differs("", expectation, str(first_error["input"]))
        return None
    compare_texts(json_text(parsed), text_of(content, name), DataPlace(findings, name))
    return parsed


def _list_present_files(folder: Path, manifest: Manifest, findings: CheckResult) -> Iterator[str]:
    """Yield the files that are listed and present; all others are differences."""
    present = {path.name for path in folder.iterdir()} - {MANIFEST}
    names = [listed.name for listed in manifest.files]
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
    for scene_file in manifest.scenes:
        place = DataPlace(findings, MANIFEST, f"scene {scene_file.name}")
        actual = digest(scene_file.toml.encode())
        place.require(scene_file.sha256 == actual, "sha256", actual, scene_file.sha256)
        try:
            scene = scene_from_toml(scene_file.toml, scene_file.name)
        except InputError as error:
            place.differs("toml", "a scene", str(error))
            continue
        if size_of(scene) > MOST_BYTES:  # what it asks for is listed, and would fill all memory
            place.differs("toml", "a scene whose data can be read", scene_file.toml)
            continue
        scenes[scene_file.name] = scene
    if scenes_folder is not None:
        expected_scenes = {
            path.stem: path.read_text(encoding="utf-8") for path in scenes_folder.glob("*.toml")
        }
        manifest_scenes = {scene_file.name: scene_file.toml for scene_file in manifest.scenes}
        for name in sorted({*expected_scenes, *manifest_scenes}):
            expected, actual_toml = expected_scenes.get(name, ""), manifest_scenes.get(name, "")
            compare_texts(expected, actual_toml, DataPlace(findings, f"{MANIFEST}: scene {name}"))
    return scenes
