"""What the files must be by themselves: complete, alike in each form, and printed in one way only.

Here nothing is computed again. Since a value is the correct rounding of its number, its radius
follows from it; since the scene says what is asked for, every name and input follows from that; and
since the same data always give the same bytes, every file follows from its scene's JSON.
"""

import ast
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations, zip_longest
from typing import Any

from verify.algebra.formula import parse
from verify.arithmetic.exact import magnitude, text
from verify.errors import InputError
from verify.files import text_of
from verify.hamiltonians.coordinates import coordinates_in
from verify.reference.check.difference import Place
from verify.reference.make.columns import (
    AFTER_A_STEP,
    MAY_LACK,
    Row,
    values_of,
)
from verify.reference.make.correct_rounding import correctly_rounded
from verify.reference.make.models import AnyData, AnyFlow, AnyProof, AnyRun, heading
from verify.reference.make.reading import rows_of
from verify.reference.make.scene_plan import orbit_tasks, proof_tasks, solution_tasks
from verify.reference.make.writing import csv_text
from verify.scenes.results.reference import FlowRow, OrbitRow, Rounded
from verify.scenes.scene import Scene

# A number's text is looked at as a text: as a rational, 1e+999999999 would fill all memory.
_OF_ENTRIES = "symplectic", "no leading entries"
_NUMBER = re.compile(r"-?([1-9](?:\.[0-9]+)?)e([+-][0-9]{2,9})")


# -- one scene's data -----------------------------------------------------------------------------


def of_data(data: AnyData, scene: Scene, file: Place) -> None:
    """What in the data is not what the scene asks for, or is not printed as it must be.

    The rows are looked at only where their inputs are those of the scene, and so of bounded size.
    """
    before = len(file.findings.differences)
    _inputs(data, scene, file)
    if len(file.findings.differences) > before:
        return
    for proof in data.proofs:
        _proof(data, proof, file.at(f"proof of {proof.scheme}"))
    state = coordinates_in(data.degrees)
    for of in (*data.runs, *data.flow):
        start = {name: x for name, x in of.start.items() if name != "t"}
        for row in of.rows:
            at, values = file.at(f"{of.label}, step {row.step}"), values_of(row, data.degrees)
            lengths = [x for x in values if x[0] in "pq"]
            at.must(lengths == list(state), "p, q", ", ".join(state), ", ".join(lengths))
            _row(row, values, start, of.digits, at)


def _inputs(data: AnyData, scene: Scene, file: Place) -> None:
    """Names and inputs, against those of the scene."""
    written = heading(scene.exact_hamiltonian())
    wanted: dict[str, Any] = {"name": scene.name, **written}
    wanted["proofs"] = [task.scheme for task in proof_tasks(scene)]
    wanted["runs"] = [(t.scheme, *t.inputs.values(), t.steps) for t in orbit_tasks(scene)]
    wanted["flow"] = [
        (*t.inputs.values(), tuple((n, text(n * t.step_size)) for n in t.steps))
        for t in solution_tasks(scene)
    ]
    found: dict[str, Any] = {name: getattr(data, name, None) for name in ("name", *written)}
    found["proofs"] = [proof.scheme for proof in data.proofs]
    found["runs"] = [(r.scheme, *_given(r), tuple(x.step for x in r.rows)) for r in data.runs]
    found["flow"] = [(*_given(f), tuple((x.step, x.time) for x in f.rows)) for f in data.flow]
    for name, value in wanted.items():
        lists = isinstance(value, list)
        pairs = zip_longest(value, found[name]) if lists else [(value, found[name])]
        for k, (mine, theirs) in enumerate(pairs):
            row = file.at(f"{name} no. {k + 1}" if lists else name)
            row.must(mine == theirs, "what is asked for", str(mine), str(theirs))
            if mine is None or theirs is None:
                break


def _given(of: AnyRun | AnyFlow) -> tuple[Any, ...]:
    """Its inputs, in the order of a task's; in the plane t0 only of an H that depends on time."""
    names = ("step_size", "q", "p", "t0", "digits")
    return tuple(getattr(of, name) for name in names if hasattr(of, name))


def _proof(data: AnyData, proof: AnyProof, row: Place) -> None:
    """What is said of S at odds with itself, or not written as it must be; in the plane S is ΔJ."""
    plane, state = data.degrees == 1, coordinates_in(data.degrees)
    column, nothing = ("area_preserving", "leading 0") if plane else _OF_ENTRIES
    keeps, told = proof.symplectic, f"order {proof.order}, leading {proof.leading}"
    zero = proof.order is None and proof.leading in ("0", {})
    row.must(zero or not keeps, column, f"no order, and {nothing}", told)
    why = ", since ΔJ is not 0" if plane else ""
    row.must(keeps is not False or proof.order is not None, "order", f"a number{why}", "null")
    weaker = not (keeps and proof.area_preserving is False)
    row.must(weaker, "area_preserving", "true, since S is 0", "false")
    entries = {f"d{a}∧d{b}" for a, b in combinations(state, 2)}
    for entry, formula in proof.entries.items():
        row.must(plane or entry in entries, "leading", "entries such as dp1∧dq1", entry)
        of_formula(formula, _names(data), f"leading {entry}".strip(), row)


def _names(data: AnyData) -> list[str]:
    """What a formula of the data may be in."""
    return [*coordinates_in(data.degrees), *(["t"] if data.timed else []), *data.parameters]


def of_formula(formula: str, names: Sequence[str], column: str, row: Place) -> None:
    """A formula in these names that is not one, or not written as it must be."""
    try:
        parse(formula, names)
        tight = ast.unparse(ast.parse(formula, mode="eval")).replace(" ", "")
    except InputError as error:
        row.differs(column, f"a formula ({error.problem})", formula)
        return
    spaced = re.sub(r" [+-] ", "", formula)  # the only place where a formula has spaces
    written = tight == formula.replace(" ", "") and " " not in spaced
    row.must(written, column, tight, formula)


_AT_FIRST = {"lambda": Fraction(0), "symplectic_defect": Fraction(0)}


def _row(
    row: OrbitRow | FlowRow,
    values: Mapping[str, Rounded | None],
    start: Mapping[str, Fraction],
    digits: int,
    at: Place,
) -> None:
    """What of a row is not as it must be, by its values and its run's initial values by column."""
    size = max(map(abs, start.values()))
    finished = row.status == "finished"
    for name, value in values.items():
        must = finished and not (name in AFTER_A_STEP and row.step == 0)
        if value is None:
            at.must(not must or name in MAY_LACK, name, "a number", "null")
        else:
            at.must(must, name, "null", value.value)
            _cell(name, value, digits, size if name in start else Fraction(1), at)
    wanted = "enclosed or estimated" if row.kind is None else "null"
    at.must((row.kind is not None) == finished, "kind", wanted, str(row.kind))
    if isinstance(row, OrbitRow):
        _failed_step(row, at)
    if row.step == 0:  # the initial value
        known = finished and row.kind == "enclosed"
        at.must(known, "status", "finished, enclosed", f"{row.status}, {row.kind}")
        for name, exact in (dict(start) | _AT_FIRST).items():
            value, rounded = values.get(name), correctly_rounded(exact, Fraction(0), digits)
            if value and rounded:
                at.must(value.value == rounded.value, name, rounded.value, value.value)


def _failed_step(row: OrbitRow, at: Place) -> None:
    left, step = row.status == "left range", row.failed_step
    at.must((step is not None) == left, "failed_step", "a step" if left else "null", str(step))
    within = step is None or 1 <= step <= row.step
    at.must(within, "failed_step", f"1 … {row.step}", str(step))


def _cell(name: str, cell: Rounded, digits: int, size: Fraction, at: Place) -> None:
    """A value that is not printed as it must be, and a radius that is not the value's."""
    radius = cell.radius
    if re.fullmatch(r"-?0(\.0*)?(e.*)?", cell.value):
        near = f"1e{(magnitude(size) if size else 0) - 2 * digits:+03d}"
        at.must(cell.value == "0", name, "0", cell.value)
        at.must(radius in ("0", near), f"{name}_radius", f"0 or {near}", radius)
        return
    match = _NUMBER.fullmatch(cell.value)
    if match is None or match[2] != f"{int(match[2]):+03d}":
        wanted = "a digit that is not 0, a point, digits, e, a sign and the exponent"
        at.differs(name, wanted, cell.value)
        return
    mantissa, exponent = match[1], int(match[2])
    count = len(mantissa.replace(".", ""))
    if radius == "0":
        short = count <= digits and (count == 1 or not mantissa.endswith("0"))
        wanted = f"at most {digits} digits, since it is exact, and no 0 at the end"
        at.must(short, name, wanted, cell.value)
        return
    tie = count == digits + 1 and mantissa.endswith("5")
    at.must(count == digits or tie, name, f"{digits} digits", cell.value)
    half = f"5e{exponent - count:+03d}"
    at.must(radius == half, f"{name}_radius", half, radius)


# -- the same in another form ---------------------------------------------------------------------


def of_table(wanted: Sequence[Row], found: Sequence[Row], file: Place) -> None:
    """Cells of a table that are not those of the scene's JSON, up to a line of another length."""
    names = wanted[0]
    for k, (mine, theirs) in enumerate(zip_longest(wanted, found), start=1):
        if mine == theirs:
            continue
        line = file.at(f"line {k}")
        if mine is None or theirs is None or len(mine) != len(theirs):
            line.differs("", _joined(mine), _joined(theirs))
            return
        for name, x, y in zip(names, mine, theirs, strict=True):
            line.must(x == y, name, x, y)


def _joined(row: Row | None) -> str:
    return "no line" if row is None else ",".join(row)


def of_text(wanted: str, found: str, file: Place) -> None:
    """The first line that is not as it must be written, where two texts differ."""
    if wanted == found:
        return
    lines = zip_longest(wanted.split("\n"), found.split("\n"))
    k, (mine, theirs) = next((k, pair) for k, pair in enumerate(lines, 1) if pair[0] != pair[1])
    at = next((i for i, (a, b) in enumerate(zip(mine or "", theirs or "", strict=False)) if a != b),
              min(len(mine or ""), len(theirs or "")))  # fmt: skip
    cut = max(0, at - 40)
    shown = (repr(x[cut : at + 40]) if x is not None else "no line" for x in (mine, theirs))
    file.at(f"line {k}").differs(f"character {at + 1}", *shown)


def of_csv(wanted: Sequence[Row], content: bytes, file: Place) -> None:
    """A CSV file against the scene's JSON, cell by cell, then character by character.

    InputError where it is not CSV.
    """
    before = len(file.findings.differences)
    of_table(wanted, rows_of(content, file.file), file)
    if len(file.findings.differences) == before:
        of_text(csv_text(list(wanted)), text_of(content, file.file), file)
