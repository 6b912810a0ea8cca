"""Reference data → the bytes of its files; the same data always give the same bytes."""

import csv
import hashlib
import io
import json
from collections.abc import Iterable, Iterator
from typing import Any

from pydantic import BaseModel

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
from verify.scenes.results.reference import FlowPoint, OrbitPoint

MANIFEST = "manifest.json"
SCHEMAS: dict[str, type[BaseModel]] = {
    "data.schema.json": Data,
    "manifest.schema.json": Manifest,
}
_DIALECT = "https://json-schema.org/draft/2020-12/schema"
Row = tuple[str, ...]


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


def tables(data: Data) -> dict[str, list[Row]]:
    """The same as tables of texts, by file name without its ending; the first row names columns."""
    return {
        f"{data.name}-proofs": list(_proof_rows(data)),
        f"{data.name}-runs": list(_run_rows(data.runs)),
        f"{data.name}-flow": list(_flow_rows(data.flow)),
    }


def names_of(scenes: Iterable[str], *, parquet: bool) -> set[str]:
    """The files that scenes of these names have, with the schemas and without the manifest."""
    found = set(SCHEMAS)
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
        yield (data.hamiltonian, given, *(_cell(found[n]) for n in names))


def _run_rows(runs: tuple[Run, ...]) -> Iterator[Row]:
    yield ("scheme", "step_size", "q0", "p0", "digits", "step", "status", "failed_step", "kind",
           *_pairs(VALUES))  # fmt: skip
    for run in runs:
        given = run.scheme, run.step_size, run.q, run.p, str(run.digits)
        for x in run.rows:
            told = str(x.step), x.status, _cell(x.failed_step), _cell(x.kind)
            yield (*given, *told, *_numbers(x))


def _flow_rows(flows: tuple[Flow, ...]) -> Iterator[Row]:
    yield ("step_size", "q0", "p0", "digits", "step", "time", "status", "kind",
           *_pairs(("p", "q")))  # fmt: skip
    for flow in flows:
        for x in flow.rows:
            given = flow.step_size, flow.q, flow.p, str(flow.digits)
            yield (*given, str(x.step), x.time, x.status, _cell(x.kind), *_numbers(x))


def _pairs(names: tuple[str, ...]) -> Row:
    return tuple(x for name in names for x in (name, f"{name}_radius"))


def _numbers(row: OrbitPoint | FlowPoint) -> Row:
    values = values_of(row).values()
    return tuple(x for v in values for x in ((v.value, v.radius) if v else ("", "")))


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


# -- the manifest ---------------------------------------------------------------------------------


def digest(content: bytes) -> str:
    """SHA-256, in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def listed(name: str, content: bytes) -> ListedFile:
    """What a manifest says of a file."""
    return ListedFile(name=name, bytes=len(content), sha256=digest(content))
