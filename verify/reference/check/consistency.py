"""What the files must be by themselves: complete, alike in each form, and printed in one way only.

Here nothing is computed again. Since a value is the correct rounding of its number, its radius
follows from it; since the scene says what is asked for, every name and input follows from that; and
since the same data always give the same bytes, every file follows from its scene's JSON.
"""

import ast
import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import zip_longest
from typing import Any

from verify.algebra.formula import parse
from verify.arithmetic.exact import magnitude, text
from verify.errors import InputError
from verify.reference.check.difference import Difference
from verify.reference.make.correct_rounding import correctly_rounded
from verify.reference.make.models import Data, Flow, Run, values_of
from verify.reference.make.reading import rows_of, text_of
from verify.reference.make.scene_plan import exact_inputs, orbit_tasks, proof_tasks, solution_tasks
from verify.reference.make.writing import Row, csv_text
from verify.scenes.results.reference import FlowPoint, OrbitPoint, Rounded
from verify.scenes.scene import Scene

# A number's text is looked at as a text: as a rational, 1e+999999999 would fill all memory.
_NUMBER = re.compile(r"-?([1-9](?:\.[0-9]+)?)e([+-][0-9]{2,9})")


# -- one scene's data -----------------------------------------------------------------------------


def of_data(data: Data, file: str, scene: Scene) -> Iterator[Difference]:
    """What in the data is not what the scene asks for, or is not printed as it must be.

    The rows are looked at only where their inputs are those of the scene, and so of bounded size.
    """
    other = list(_inputs(data, file, scene))
    if other:
        yield from other
        return
    for proof in data.proofs:
        yield from _proof(data, file, proof)
    tables: tuple[Run | Flow, ...] = (*data.runs, *data.flow)
    for of in tables:
        for row in of.rows:
            yield from _row(file, of, row)


def _inputs(data: Data, file: str, scene: Scene) -> Iterator[Difference]:
    """Names and inputs, against those of the scene."""
    written = scene.exact_hamiltonian().texts
    wanted: dict[str, Any] = {"name": scene.name, **written}
    wanted["proofs"] = [task.scheme for task in proof_tasks(scene)]
    wanted["runs"] = [(t.scheme, *exact_inputs(t).values(), t.steps) for t in orbit_tasks(scene)]
    wanted["flow"] = [
        (*exact_inputs(t).values(), tuple((n, text(n * t.step_size)) for n in t.steps))
        for t in solution_tasks(scene)
    ]
    found: dict[str, Any] = {name: getattr(data, name) for name in ("name", *written)}
    found["proofs"] = [proof.scheme for proof in data.proofs]
    found["runs"] = [
        (r.scheme, r.step_size, r.q, r.p, r.digits, tuple(x.step for x in r.rows))
        for r in data.runs
    ]
    found["flow"] = [
        (f.step_size, f.q, f.p, f.digits, tuple((x.step, x.time) for x in f.rows))
        for f in data.flow
    ]
    for name, value in wanted.items():
        lists = isinstance(value, list)
        pairs = zip_longest(value, found[name]) if lists else [(value, found[name])]
        for k, (mine, theirs) in enumerate(pairs):
            if mine != theirs:
                row = f"{name} no. {k + 1}" if lists else name
                yield Difference(file, row, "what is asked for", str(mine), str(theirs))
            if mine is None or theirs is None:
                break


def _proof(data: Data, file: str, proof: Any) -> Iterator[Difference]:
    row = f"proof of {proof.scheme}"
    if proof.area_preserving and (proof.order, proof.leading) != (None, "0"):
        found = f"order {proof.order}, leading {proof.leading}"
        yield Difference(file, row, "area_preserving", "no order, and leading 0", found)
    if proof.area_preserving is False and proof.order is None:
        yield Difference(file, row, "order", "a number, since ΔJ is not 0", "null")
    try:
        parse(proof.leading, ["p", "q", *data.parameters])
        tight = ast.unparse(ast.parse(proof.leading, mode="eval")).replace(" ", "")
    except InputError as error:
        yield Difference(file, row, "leading", f"a formula ({error.problem})", proof.leading)
        return
    spaced = re.sub(r" [+-] ", "", proof.leading)  # the only place where a formula has spaces
    if tight != proof.leading.replace(" ", "") or " " in spaced:
        yield Difference(file, row, "leading", tight, proof.leading)


def _row(file: str, of: Run | Flow, row: OrbitPoint | FlowPoint) -> Iterator[Difference]:
    label, values = f"{of.label}, step {row.step}", values_of(row)
    start = {"p": Fraction(of.p), "q": Fraction(of.q)}
    size = max(map(abs, start.values()))
    finished = row.status == "finished"
    for name, value in values.items():
        must = finished and not (name == "mse" and row.step == 0)
        if value is None and must and name != "delta_j":
            yield Difference(file, label, name, "a number", "null")
        if value is not None and not must:
            yield Difference(file, label, name, "null", value.value)
        if value is not None:
            scale = size if name in start else Fraction(1)
            yield from _cell(file, label, name, value, of.digits, scale)
    if (row.kind is not None) != finished:
        wanted = "enclosed or estimated" if row.kind is None else "null"
        yield Difference(file, label, "kind", wanted, str(row.kind))
    if isinstance(row, OrbitPoint):
        yield from _failed_step(file, label, row)
    if row.step == 0:  # the initial value
        if not finished or row.kind != "enclosed":
            given = f"{row.status}, {row.kind}"
            yield Difference(file, label, "status", "finished, enclosed", given)
        for name, exact in (start | {"lambda": Fraction(0)}).items():
            value, known = values.get(name), correctly_rounded(exact, Fraction(0), of.digits)
            if value and known and value.value != known.value:
                yield Difference(file, label, name, known.value, value.value)


def _failed_step(file: str, label: str, row: OrbitPoint) -> Iterator[Difference]:
    left, at = row.status == "left range", row.failed_step
    if (at is not None) != left:
        yield Difference(file, label, "failed_step", "a step" if left else "null", str(at))
    if at is not None and not 1 <= at <= row.step:
        yield Difference(file, label, "failed_step", f"1 … {row.step}", str(at))


def _cell(
    file: str, label: str, name: str, cell: Rounded, digits: int, size: Fraction
) -> Iterator[Difference]:
    """A value that is not printed as it must be, and a radius that is not the value's."""
    radius = cell.radius
    if re.fullmatch(r"-?0(\.0*)?(e.*)?", cell.value):
        near = f"1e{(magnitude(size) if size else 0) - 2 * digits:+03d}"
        if cell.value != "0":
            yield Difference(file, label, name, "0", cell.value)
        if radius not in ("0", near):
            yield Difference(file, label, f"{name}_radius", f"0 or {near}", radius)
        return
    match = _NUMBER.fullmatch(cell.value)
    if match is None or match[2] != f"{int(match[2]):+03d}":
        wanted = "a digit that is not 0, a point, digits, e, a sign and the exponent"
        yield Difference(file, label, name, wanted, cell.value)
        return
    mantissa, exponent = match[1], int(match[2])
    count = len(mantissa.replace(".", ""))
    if radius == "0":
        if count > digits or (count > 1 and mantissa.endswith("0")):
            wanted = f"at most {digits} digits, since it is exact, and no 0 at the end"
            yield Difference(file, label, name, wanted, cell.value)
        return
    tie = count == digits + 1 and mantissa.endswith("5")
    if count != digits and not tie:
        yield Difference(file, label, name, f"{digits} digits", cell.value)
    half = f"5e{exponent - count:+03d}"
    if radius != half:
        yield Difference(file, label, f"{name}_radius", half, radius)


# -- the same in another form ---------------------------------------------------------------------


def of_table(wanted: Sequence[Row], found: Sequence[Row], file: str) -> Iterator[Difference]:
    """Cells of a table that are not those of the scene's JSON, up to a line of another length."""
    names = wanted[0]
    for k, (mine, theirs) in enumerate(zip_longest(wanted, found), start=1):
        if mine == theirs:
            continue
        if mine is None or theirs is None or len(mine) != len(theirs):
            yield Difference(file, f"line {k}", "", _joined(mine), _joined(theirs))
            return
        for name, x, y in zip(names, mine, theirs, strict=True):
            if x != y:
                yield Difference(file, f"line {k}", name, x, y)


def _joined(row: Row | None) -> str:
    return "no line" if row is None else ",".join(row)


def of_text(wanted: str, found: str, file: str) -> Iterator[Difference]:
    """The first line that is not as it must be written, where two texts differ."""
    if wanted == found:
        return
    lines = zip_longest(wanted.split("\n"), found.split("\n"))
    k, (mine, theirs) = next((k, pair) for k, pair in enumerate(lines, 1) if pair[0] != pair[1])
    at = next((i for i, (a, b) in enumerate(zip(mine or "", theirs or "", strict=False)) if a != b),
              min(len(mine or ""), len(theirs or "")))  # fmt: skip
    cut = max(0, at - 40)
    shown = (repr(x[cut : at + 40]) if x is not None else "no line" for x in (mine, theirs))
    yield Difference(file, f"line {k}", f"character {at + 1}", *shown)


def of_csv(wanted: Sequence[Row], content: bytes, file: str) -> Iterator[Difference]:
    """A CSV file against the scene's JSON, cell by cell, then character by character.

    InputError where it is not CSV.
    """
    cells = list(of_table(wanted, rows_of(content, file), file))
    yield from cells or of_text(csv_text(list(wanted)), text_of(content, file), file)
