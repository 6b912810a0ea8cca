"""Reference data → the bytes of its files; the same data always give the same bytes."""

import csv
import hashlib
import io
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from verify.hamiltonians.coordinates import coordinates_in
from verify.reference.make.models import (
    MODELS,
    AnyData,
    AnyFlow,
    AnyRun,
    Data,
    DataInDegrees,
    Name,
    Proof,
    ProofInDegrees,
)
from verify.reference.make.row_values import Row, cell, orbit_columns, start_columns, values_of
from verify.scenes.frozen import Frozen

ManifestFormat = Literal["areaproof reference manifest 1"]
MANIFEST_FORMAT: ManifestFormat = "areaproof reference manifest 1"
Digest = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]


class SceneFile(Frozen):
    """A scene that data were made from."""

    name: Name = Field(description="the scene's name")
    toml: str = Field(description="the scene as it was written, a TOML text")
    sha256: Digest = Field(description="SHA-256 of that text in UTF-8")


class ListedFile(Frozen):
    """A file beside the manifest."""

    name: Name = Field(description="its name in the manifest's folder")
    bytes: int = Field(ge=0, description="its size")
    sha256: Digest = Field(description="SHA-256 of its content")


class Manifest(Frozen):
    """What made a folder of reference data, and each file that belongs to it."""

    model_config = ConfigDict(title="areaproof reference manifest")

    format: ManifestFormat = Field(description="this format")
    command: str = Field(description="the command that made the files")
    versions: dict[str, str] = Field(description="versions of Python and of the libraries that did")
    scenes: tuple[SceneFile, ...] = Field(description="what was asked for")
    files: tuple[ListedFile, ...] = Field(description="all files but the manifest itself, by name")


MANIFEST = "manifest.json"
OF_DEGREES = "data-in-degrees.schema.json"
SCHEMAS: dict[str, type[BaseModel]] = {
    "data.schema.json": Data,
    "manifest.schema.json": Manifest,
    OF_DEGREES: DataInDegrees,
}
_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_OF_ORBIT: Row = ("step", "status", "failed_step", "kind")
_OF_FLOW: Row = ("step", "time", "status", "kind")


def json_text(model: BaseModel) -> str:
    """Return the model as JSON; a value that contains no list stands on one line."""
    return "".join(_lines(model.model_dump(mode="json", by_alias=True), "")) + "\n"


def _lines(value: Any, indent: str) -> Iterator[str]:
    if not isinstance(value, dict | list) or not value or not _has_list(value):
        yield json.dumps(value, ensure_ascii=False)
        return
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    entries = value.items() if isinstance(value, dict) else ((None, x) for x in value)
    inner, comma = f"{indent} ", ""
    yield opening
    for name, x in entries:
        # One line for each value without a list: files stay readable, and a change of one row
        # changes one line.
        key = "" if name is None else f"{json.dumps(name, ensure_ascii=False)}: "
        yield f"{comma}\n{inner}{key}"
        yield from _lines(x, inner)
        comma = ","
    yield f"\n{indent}{closing}"


def _has_list(value: Any) -> bool:
    if isinstance(value, list):
        return True
    return isinstance(value, dict) and any(map(_has_list, value.values()))


def schema_text(name: str) -> str:
    """Return the JSON Schema of that name, in the dialect of 2020-12."""
    schema = SCHEMAS[name].model_json_schema(by_alias=True, mode="serialization")
    return json.dumps({"$schema": _DIALECT} | schema, ensure_ascii=False, indent=1) + "\n"


# -- tables ---------------------------------------------------------------------------------------


def tables(data: AnyData) -> dict[str, list[Row]]:
    """Return the same as tables of texts, by file name without its ending; the first row names
    columns."""
    state = coordinates_in(data.degrees)
    columns = (*state, *orbit_columns(data.degrees))
    return {
        f"{data.name}-proofs": list(_proof_rows(data)),
        f"{data.name}-runs": list(_rows(data, data.runs, ("scheme",), _OF_ORBIT, columns)),
        f"{data.name}-flow": list(_rows(data, data.flow, (), _OF_FLOW, state)),
    }


def schemas_for(formats: Iterable[str]) -> tuple[str, ...]:
    """Return the schemas of a folder that has data of these formats, and the manifest's."""
    models = {MODELS[name] for name in formats} or {Data}
    return tuple(name for name, model in SCHEMAS.items() if model in {*models, Manifest})


def names_of(scenes: Mapping[str, str], *, parquet: bool) -> set[str]:
    """Return the files of scenes, with the schemas and without the manifest.

    `scenes`: the format of each scene's data, by its name.
    """
    names = set(schemas_for(scenes.values()))
    for name in scenes:
        names.add(f"{name}.json")
        for ending in ("csv", "parquet") if parquet else ("csv",):
            names |= {f"{name}-{table}.{ending}" for table in ("proofs", "runs", "flow")}
    return names


def csv_text(rows: list[Row]) -> str:
    """Return a table as CSV, its lines ending with a line feed."""
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue()


def _proof_rows(data: AnyData) -> Iterator[Row]:
    names = (Proof if isinstance(data, Data) else ProofInDegrees).model_fields
    yield ("hamiltonian", "parameters", *names)
    parameters = "; ".join(f"{name} = {value}" for name, value in data.parameters.items())
    for proof in data.proofs:
        content = proof.model_dump(mode="json")
        yield (data.hamiltonian, parameters, *(cell(content[name]) for name in names))


def _rows(
    data: AnyData,
    tables: Sequence[AnyRun | AnyFlow],
    item_fields: Row,
    row_fields: Row,
    numbers: Row,
) -> Iterator[Row]:
    """Yield a line for each row; `item_fields` are fields of its run or flow, `row_fields` and
    `numbers` its own."""
    time: Row = ("t0",) if data.time_dependent else ()
    pairs = (x for name in numbers for x in (name, f"{name}_radius"))
    yield (
        *item_fields,
        "step_size",
        *start_columns(data.degrees),
        *time,
        "digits",
        *row_fields,
        *pairs,
    )
    for item in tables:
        inputs = [
            *(getattr(item, name) for name in (*item_fields, "step_size")),
            *item.texts.values(),
            *(cell(item.begins) for _ in time),
            cell(item.digits),
        ]
        for row in item.rows:
            values = values_of(row, data.degrees)
            rounded = (values.get(name) for name in numbers)
            cells = (x for v in rounded for x in ((v.value, v.radius) if v else ("", "")))
            yield (*inputs, *(cell(getattr(row, name)) for name in row_fields), *cells)


# -- the manifest ---------------------------------------------------------------------------------


def digest(content: bytes) -> str:
    """Return SHA-256, in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def describe_file(name: str, content: bytes) -> ListedFile:
    """Return a manifest's entry of a file."""
    return ListedFile(name=name, bytes=len(content), sha256=digest(content))
