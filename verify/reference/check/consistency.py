"""What the files must be by themselves: complete, alike in each form, and printed in one way only.

Here nothing is computed again. Since a value is the correct rounding of its number, its radius
follows from it; since the scene says what is asked for, every name and input follows from that; and
since the same data always give the same bytes, every file follows from its scene's JSON.
"""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import zip_longest
from typing import Any

from verify.algebra.formula import parse
from verify.arithmetic.exact import magnitude, text
from verify.errors import InputError
from verify.reference.check.difference import Difference
from verify.reference.make.correct_rounding import correctly_rounded
from verify.reference.make.models import Data, Flow, Run
from verify.reference.make.reading import rows_of, text_of
from verify.reference.make.scene_plan import orbit_tasks, proof_tasks, solution_tasks
from verify.reference.make.writing import Row, csv_text
from verify.scenes.results.reference import FlowPoint, OrbitPoint, Rounded
from verify.scenes.scene import Scene

_VALUES = ("p", "q", "delta_j", "mse", "lam")
_SHOWN = {"lam": "lambda"}
# A number's text is looked at as a text: as a rational, 1e+999999999 would fill all memory.
_NUMBER = re.compile(r"-?([1-9](?:\.[0-9]+)?)e([+-][0-9]{2,9})")


def run_label(run: Run, step: int) -> str:
    return f"{run.scheme}, h = {run.step_size}, (q, p) = ({run.q}, {run.p}), step {step}"


def flow_label(flow: Flow, step: int) -> str:
    return f"exact flow, h = {flow.step_size}, (q, p) = ({flow.q}, {flow.p}), step {step}"


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
    for run in data.runs:
        for row in run.rows:
            yield from _orbit_row(file, run, row)
    for flow in data.flow:
        for point in flow.rows:
            yield from _flow_row(file, flow, point)


def _inputs(data: Data, file: str, scene: Scene) -> Iterator[Difference]:
    """Names and inputs, against those of the scene."""
    written = scene.exact_hamiltonian().texts
    wanted: dict[str, Any] = {"name": scene.name, **written}
    wanted["proofs"] = [task.scheme for task in proof_tasks(scene)]
    wanted["runs"] = [
        (t.scheme, text(t.step_size), text(t.q), text(t.p), t.digits, t.steps)
        for t in orbit_tasks(scene)
    ]
    wanted["flow"] = [
        (text(t.step_size), text(t.q), text(t.p), t.digits,
         tuple((n, text(n * t.step_size)) for n in t.steps))
        for t in solution_tasks(scene)
    ]  # fmt: skip
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


def _orbit_row(file: str, run: Run, row: OrbitPoint) -> Iterator[Difference]:
    label = run_label(run, row.step)
    size = max(abs(Fraction(run.p)), abs(Fraction(run.q)))
    for name in _VALUES:
        shown, value = _SHOWN.get(name, name), getattr(row, name)
        must = row.status == "finished" and not (name == "mse" and row.step == 0)
        if value is None and must and name != "delta_j":
            yield Difference(file, label, shown, "a number", "null")
        if value is not None and not must:
            yield Difference(file, label, shown, "null", value.value)
        if value is not None:
            scale = size if name in ("p", "q") else Fraction(1)
            yield from _cell(file, label, shown, value, run.digits, scale)
    yield from _status(file, label, row)
    if (row.failed_step is not None) != (row.status == "left range"):
        wanted = "a step" if row.status == "left range" else "null"
        yield Difference(file, label, "failed_step", wanted, str(row.failed_step))
    if row.failed_step is not None and not 1 <= row.failed_step <= row.step:
        yield Difference(file, label, "failed_step", f"1 … {row.step}", str(row.failed_step))
    if row.step == 0:
        start = {"p": Fraction(run.p), "q": Fraction(run.q), "lam": Fraction(0)}
        yield from _start(file, label, row, start, run.digits)


def _flow_row(file: str, flow: Flow, row: FlowPoint) -> Iterator[Difference]:
    label = flow_label(flow, row.step)
    size = max(abs(Fraction(flow.p)), abs(Fraction(flow.q)))
    for name in ("p", "q"):
        value = getattr(row, name)
        if (value is not None) != (row.status == "finished"):
            wanted = "a number" if value is None else "null"
            yield Difference(file, label, name, wanted, value.value if value else "null")
        if value is not None:
            yield from _cell(file, label, name, value, flow.digits, size)
    yield from _status(file, label, row)
    if row.step == 0:
        start = {"p": Fraction(flow.p), "q": Fraction(flow.q)}
        yield from _start(file, label, row, start, flow.digits)


def _status(file: str, label: str, row: OrbitPoint | FlowPoint) -> Iterator[Difference]:
    if (row.kind is not None) != (row.status == "finished"):
        wanted = "enclosed or estimated" if row.kind is None else "null"
        yield Difference(file, label, "kind", wanted, str(row.kind))


def _start(
    file: str, label: str, row: Any, wanted: Mapping[str, Fraction], digits: int
) -> Iterator[Difference]:
    """The values at N = 0 against the initial value."""
    if row.status != "finished" or row.kind != "enclosed":
        yield Difference(file, label, "status", "finished, enclosed", f"{row.status}, {row.kind}")
    for name, exact in wanted.items():
        value, must = getattr(row, name), correctly_rounded(exact, Fraction(0), digits)
        if value and must and value.value != must.value:
            yield Difference(file, label, _SHOWN.get(name, name), must.value, value.value)


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
