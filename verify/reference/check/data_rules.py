"""Rules that data and manifest must obey by themselves: complete, and printed in one way only.

Nothing is computed again here. Since a value is the correct rounding of its number, its radius
follows from it; since the scene says what is requested, every name and input follows from that; and
since the same data always give the same bytes, every file follows from its scene's JSON
(`verify.reference.check.difference` compares them).
"""

import ast
import re
import shlex
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations, zip_longest
from typing import Any

from verify.algebra.formula import parse
from verify.arithmetic.exact import magnitude, text
from verify.errors import InputError
from verify.execution.provenance import versions
from verify.hamiltonians.coordinates import coordinates_in
from verify.reference.check.difference import DataFindings, DataPlace
from verify.reference.make.data_files import MANIFEST, Manifest, names_of
from verify.reference.make.models import AnyData, AnyFlow, AnyProof, AnyRun, format_of, heading
from verify.reference.make.row_values import AFTER_A_STEP, MAY_LACK, correctly_rounded, values_of
from verify.reference.make.scene_plan import orbit_tasks, proof_tasks, solution_tasks
from verify.scenes.results.reference import FlowRow, OrbitRow, Rounded
from verify.scenes.scene import Scene, scene_from_toml

# A number's text is looked at as a text: as a rational, 1e+999999999 would fill all memory.
_OF_ENTRIES = "symplectic", "no leading entries"
_VERSION = re.compile(r"[0-9]+(\.[0-9a-z+]+)*")
_NO_MORE = ("numba",)  # what data may name that were made with it, and is not used any more
_NUMBER = re.compile(r"-?([1-9](?:\.[0-9]+)?)e([+-][0-9]{2,9})")


# -- one scene's data -----------------------------------------------------------------------------


def check_data(data: AnyData, scene: Scene, file: DataPlace) -> None:
    """Report what in the data differs from the scene's request, or is not printed as it must be.

    The rows are checked only if their inputs are those of the scene, and so of bounded size.
    """
    before = len(file.findings.differences)
    _check_inputs(data, scene, file)
    # Rows may be as many as a hostile file wishes; their number is bounded only once the inputs are
    # those of the scene.
    if len(file.findings.differences) > before:
        return
    for proof in data.proofs:
        _check_proof(data, proof, file.at_row(f"proof of {proof.scheme}"))
    state = coordinates_in(data.degrees)
    for item in (*data.runs, *data.flow):
        start = {name: x for name, x in item.start.items() if name != "t"}
        for row in item.rows:
            place = file.at_row(f"{item.label}, step {row.step}")
            values = values_of(row, data.degrees)
            lengths = [x for x in values if x[0] in "pq"]
            place.require(lengths == list(state), "p, q", ", ".join(state), ", ".join(lengths))
            _check_row(row, values, start, item.digits, place)


def _check_inputs(data: AnyData, scene: Scene, file: DataPlace) -> None:
    """Compare names and inputs with those of the scene."""
    fields = heading(scene.exact_hamiltonian())
    expected: dict[str, Any] = {"name": scene.name, **fields}
    expected["proofs"] = [task.scheme for task in proof_tasks(scene)]
    expected["runs"] = [(t.scheme, *t.inputs.values(), t.steps) for t in orbit_tasks(scene)]
    expected["flow"] = [
        (*t.inputs.values(), tuple((n, text(n * t.step_size)) for n in t.steps))
        for t in solution_tasks(scene)
    ]
    actual: dict[str, Any] = {name: getattr(data, name, None) for name in ("name", *fields)}
    actual["proofs"] = [proof.scheme for proof in data.proofs]
    actual["runs"] = [(r.scheme, *_inputs_of(r), tuple(x.step for x in r.rows)) for r in data.runs]
    actual["flow"] = [(*_inputs_of(f), tuple((x.step, x.time) for x in f.rows)) for f in data.flow]
    for name, value in expected.items():
        lists = isinstance(value, list)
        pairs = zip_longest(value, actual[name]) if lists else [(value, actual[name])]
        for k, (expected_item, actual_item) in enumerate(pairs):
            row = file.at_row(f"{name} no. {k + 1}" if lists else name)
            row.require(
                expected_item == actual_item,
                "what is asked for",
                str(expected_item),
                str(actual_item),
            )
            if expected_item is None or actual_item is None:
                break


def _inputs_of(item: AnyRun | AnyFlow) -> tuple[Any, ...]:
    """Return the inputs in the order of a task's; in the plane t0 only of an H that depends on
    time."""
    names = ("step_size", "q", "p", "t0", "digits")
    return tuple(getattr(item, name) for name in names if hasattr(item, name))


def _check_proof(data: AnyData, proof: AnyProof, row: DataPlace) -> None:
    """Report where statements on S contradict each other or are not written as they must be; in the
    plane S is ΔJ."""
    plane, state = data.degrees == 1, coordinates_in(data.degrees)
    column, nothing = ("area_preserving", "leading 0") if plane else _OF_ENTRIES
    keeps, stated = proof.symplectic, f"order {proof.order}, leading {proof.leading}"
    zero = proof.order is None and proof.leading in ("0", {})
    row.require(zero or not keeps, column, f"no order, and {nothing}", stated)
    reason = ", since ΔJ is not 0" if plane else ""
    row.require(keeps is not False or proof.order is not None, "order", f"a number{reason}", "null")
    weaker = not (keeps and proof.area_preserving is False)
    row.require(weaker, "area_preserving", "true, since S is 0", "false")
    entries = {f"d{a}∧d{b}" for a, b in combinations(state, 2)}
    for entry, formula in proof.entries.items():
        row.require(plane or entry in entries, "leading", "entries such as dp1∧dq1", entry)
        check_formula(formula, _names_in_formulas(data), f"leading {entry}".strip(), row)


def _names_in_formulas(data: AnyData) -> list[str]:
    """Return the names that a formula of the data may contain."""
    return [
        *coordinates_in(data.degrees),
        *(["t"] if data.time_dependent else []),
        *data.parameters,
    ]


def check_formula(formula: str, names: Sequence[str], column: str, row: DataPlace) -> None:
    """Report a text that is no formula in these names, or is not written as it must be."""
    try:
        parse(formula, names)
        # Python's own parser and printer define the canonical form: a formula written otherwise was
        # not printed by the toolkit.
        tight = ast.unparse(ast.parse(formula, mode="eval")).replace(" ", "")
    except InputError as error:
        row.differs(column, f"a formula ({error.problem})", formula)
        return
    spaced = re.sub(r" [+-] ", "", formula)  # the only place at which a formula has spaces
    is_canonical = tight == formula.replace(" ", "") and " " not in spaced
    row.require(is_canonical, column, tight, formula)


_AT_FIRST = {"lambda": Fraction(0), "symplectic_defect": Fraction(0)}


def _check_row(
    row: OrbitRow | FlowRow,
    values: Mapping[str, Rounded | None],
    start: Mapping[str, Fraction],
    digits: int,
    place: DataPlace,
) -> None:
    """Report errors of a row, from its values and from its run's initial values by column."""
    size = max(map(abs, start.values()))
    finished = row.status == "finished"
    for name, value in values.items():
        must = finished and not (name in AFTER_A_STEP and row.step == 0)
        if value is None:
            place.require(not must or name in MAY_LACK, name, "a number", "null")
        else:
            place.require(must, name, "null", value.value)
            _check_cell(name, value, digits, size if name in start else Fraction(1), place)
    expected = "enclosed or estimated" if row.kind is None else "null"
    place.require((row.kind is not None) == finished, "kind", expected, str(row.kind))
    if isinstance(row, OrbitRow):
        _check_failed_step(row, place)
    if row.step == 0:  # the initial value
        is_exact = finished and row.kind == "enclosed"
        place.require(is_exact, "status", "finished, enclosed", f"{row.status}, {row.kind}")
        for name, number in (dict(start) | _AT_FIRST).items():
            value, rounded = values.get(name), correctly_rounded(number, Fraction(0), digits)
            if value and rounded:
                place.require(value.value == rounded.value, name, rounded.value, value.value)


def _check_failed_step(row: OrbitRow, place: DataPlace) -> None:
    escaped, step = row.status == "left range", row.failed_step
    place.require(
        (step is not None) == escaped, "failed_step", "a step" if escaped else "null", str(step)
    )
    in_range = step is None or 1 <= step <= row.step
    place.require(in_range, "failed_step", f"1 … {row.step}", str(step))


def _check_cell(name: str, cell: Rounded, digits: int, size: Fraction, place: DataPlace) -> None:
    """Report a value that is not printed as it must be, and a radius that is not the value's."""
    radius = cell.radius
    if re.fullmatch(r"-?0(\.0*)?(e.*)?", cell.value):
        near_zero = f"1e{(magnitude(size) if size else 0) - 2 * digits:+03d}"
        place.require(cell.value == "0", name, "0", cell.value)
        place.require(radius in ("0", near_zero), f"{name}_radius", f"0 or {near_zero}", radius)
        return
    match = _NUMBER.fullmatch(cell.value)
    if match is None or match[2] != f"{int(match[2]):+03d}":
        expected = "a digit that is not 0, a point, digits, e, a sign and the exponent"
        place.differs(name, expected, cell.value)
        return
    mantissa, exponent = match[1], int(match[2])
    count = len(mantissa.replace(".", ""))
    if radius == "0":
        short = count <= digits and (count == 1 or not mantissa.endswith("0"))
        expected = f"at most {digits} digits, since it is exact, and no 0 at the end"
        place.require(short, name, expected, cell.value)
        return
    # A number halfway between two decimals is printed with one digit more (see
    # `verify.reference.make.row_values`).
    tie = count == digits + 1 and mantissa.endswith("5")
    place.require(count == digits or tie, name, f"{digits} digits", cell.value)
    # A correctly rounded decimal is off by at most half a unit of its last place, so the radius
    # carries no information of its own and must be exactly that half.
    half = f"5e{exponent - count:+03d}"
    place.require(radius == half, f"{name}_radius", half, radius)


# -- the manifest ---------------------------------------------------------------------------------


def check_provenance(manifest: Manifest, scenes: dict[str, Scene], findings: DataFindings) -> None:
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
    """Return the command that should be named; None if the one named may have made the files."""
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
        for file, scene_file in zip_longest(files, manifest.scenes):
            stem = (file or "").removesuffix(".toml")
            if scene_file is None or scene_from_toml(scene_file.toml, stem).name != scene_file.name:
                return " ".join(f"{name}.toml" for name in scenes)
    return None


def check_completeness(
    manifest: Manifest, scenes: dict[str, Scene], findings: DataFindings
) -> None:
    """Check that each scene has its files, and each file its scene."""
    formats = {name: format_of(x.exact_hamiltonian().degrees) for name, x in scenes.items()}
    expected = names_of(formats, parquet="--parquet" in manifest.command.split())
    names = [listed.name for listed in manifest.files]
    one_each = len(scenes) == len(manifest.scenes)
    DataPlace(findings, MANIFEST, "scenes").require(one_each, "", "one of each name", "two")
    files = DataPlace(findings, MANIFEST, "files")
    for name in sorted(expected ^ set(names)):
        states = ("listed", "not listed") if name in expected else ("not listed", "listed")
        files.differs(name, *states)
    files.require(names == sorted(names), "", "in the order of names", "not")
