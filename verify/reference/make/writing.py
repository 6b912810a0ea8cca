"""Reference data → the bytes of its files; the same data always give the same bytes."""

import csv
import hashlib
import io
import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from verify.reference.make.cells import Row, cell
from verify.reference.make.models import (
    VALUES,
    Data,
    Flow,
    ListedFile,
    Manifest,
    Proof,
    Run,
    values_of,
)
from verify.reference.make.models_in_degrees import DataInDegrees
from verify.reference.make.tables_in_degrees import tables_in_degrees
from verify.scenes.results.reference import FlowPoint, OrbitPoint

MANIFEST = "manifest.json"
AnyData = Data | DataInDegrees
OF_DEGREES = "data-in-degrees.schema.json"
SCHEMAS: dict[str, type[BaseModel]] = {
    "data.schema.json": Data,
    "manifest.schema.json": Manifest,
    OF_DEGREES: DataInDegrees,
}
_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_GIVEN: Row = ("step_size", "q", "p", "digits")
_GIVEN_IN_TIME: Row = ("step_size", "q", "p", "t0", "digits")
_OF_ORBIT: Row = ("step", "status", "failed_step", "kind")
_OF_FLOW: Row = ("step", "time", "status", "kind")


def json_text(model: BaseModel) -> str:
    """The model as JSON: what has no list in it stands on one line."""
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
    """The JSON Schema of that name, in the dialect of 2020-12."""
    schema = SCHEMAS[name].model_json_schema(by_alias=True, mode="serialization")
    return json.dumps({"$schema": _DIALECT} | schema, ensure_ascii=False, indent=1) + "\n"


# -- tables ---------------------------------------------------------------------------------------


def tables(data: AnyData) -> dict[str, list[Row]]:
    """The same as tables of texts, by file name without its ending; the first row names columns."""
    if isinstance(data, DataInDegrees):
        return tables_in_degrees(data)
    given = _GIVEN_IN_TIME if data.timed else _GIVEN
    return {
        f"{data.name}-proofs": list(_proof_rows(data)),
        f"{data.name}-runs": list(_rows(data.runs, ("scheme", *given), _OF_ORBIT, VALUES)),
        f"{data.name}-flow": list(_rows(data.flow, given, _OF_FLOW, ("p", "q"))),
    }


def schemas_for(planar: Iterable[bool]) -> tuple[str, ...]:
    """The schemas of a folder whose scenes are of the plane, or not: those that it needs, and the
    manifest's."""
    kinds = set(planar)
    needed = {"data.schema.json": True in kinds or not kinds, OF_DEGREES: False in kinds}
    return tuple(name for name in SCHEMAS if needed.get(name, True))


def names_of(scenes: Mapping[str, bool], *, parquet: bool) -> set[str]:
    """The files that scenes of these names have, with the schemas and without the manifest; of each
    it is said whether it is of the plane."""
    found = set(schemas_for(scenes.values()))
    for name in scenes:
        found.add(f"{name}.json")
        for ending in ("csv", "parquet") if parquet else ("csv",):
            found |= {f"{name}-{what}.{ending}" for what in ("proofs", "runs", "flow")}
    return found


def csv_text(rows: list[Row]) -> str:
    """A table as CSV, its lines ending with a line feed."""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def _proof_rows(data: Data) -> Iterator[Row]:
    names = tuple(Proof.model_fields)
    yield ("hamiltonian", "parameters", *names)
    given = "; ".join(f"{name} = {value}" for name, value in data.parameters.items())
    for proof in data.proofs:
        found = proof.model_dump(mode="json")
        yield (data.hamiltonian, given, *(cell(found[n]) for n in names))


def _rows(tables: tuple[Run | Flow, ...], given: Row, told: Row, numbers: Row) -> Iterator[Row]:
    """A row each; `given` are fields of its run or flow, `told` and `numbers` its own."""
    pairs = (x for name in numbers for x in (name, f"{name}_radius"))
    yield (*({"q": "q0", "p": "p0"}.get(name, name) for name in given), *told, *pairs)
    for of in tables:
        inputs = [cell(getattr(of, name)) for name in given]
        for row in of.rows:
            yield (*inputs, *(cell(getattr(row, name)) for name in told), *_numbers(row))


def _numbers(row: OrbitPoint | FlowPoint) -> Row:
    values = values_of(row).values()
    return tuple(x for v in values for x in ((v.value, v.radius) if v else ("", "")))


# -- the manifest ---------------------------------------------------------------------------------


def digest(content: bytes) -> str:
    """SHA-256, in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def listed(name: str, content: bytes) -> ListedFile:
    """What a manifest says of a file."""
    return ListedFile(name=name, bytes=len(content), sha256=digest(content))
