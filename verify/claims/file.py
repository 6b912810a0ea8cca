"""The file that holds claims, in TOML: read, and every error said with its line.

    title = "A paper"

    [defaults]                      # keys that claims share, where they do not say otherwise
    scheme = "lie2"
    hamiltonian = "p**2/2 - cos(q)"

    [[claim]]
    id = "eq-3"
    source = "Eq. 3"                # these three may be left out
    section = "2 The scheme"         # a report groups the claims by it
    statement = "ΔJ is of order h³."
    kind = "order"
    order = 3

See `verify.claims.kinds` for the kinds, `verify.claims.scenes` for what a claim may speak of, and
`verify.scenes.paper_figures` for `[[figure]]`. A scene that a claim names is a `[[scene]]` of this
file, or the file of that name beside it.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from verify import schemes
from verify.arithmetic.exact import text
from verify.claims.every_hamiltonian import read_every_formula
from verify.claims.formulas import read_formulas
from verify.claims.growth import growth_tasks
from verify.claims.kinds import (
    EVERY_SEPARABLE,
    KINDS,
    Claim,
    DeltaJClaim,
    GrowthClaim,
    MagnitudeClaim,
    TableClaim,
    TheoremClaim,
    ValueClaim,
)
from verify.claims.scenes import (
    HAMILTONIAN_KEYS,
    HAMILTONIAN_SOURCES,
    ON_RUNS,
    ONE_RUN,
    RUN_KEYS,
    scene_for,
)
from verify.claims.toml_lines import Lines, lines_of
from verify.errors import InputError
from verify.scenes.paper_figures import PaperFigure
from verify.scenes.scene import Scene, load_scene, one_line, read_toml, scene_from

_ROOT = ("title", "defaults", "scene", "claim", "figure")
# Of each group a claim needs one: where it gives one itself, it takes none from the defaults.
_GROUPS = (
    HAMILTONIAN_KEYS,
    ("time", "steps"),
    ("step_size", "step_sizes"),
    ("q", "p", "initial_values"),
    ("printed", "lg_printed", "rows"),
)
_EVERY_KINDS = tuple(kind for kind, model in KINDS.items() if "every" in model.model_fields)
_ALSO = {"parameter": ("parameters",), "step_size": ("step_sizes",), "number": ()}


@dataclass
class ClaimsFile:
    """The claims in their order, with the scenes they speak of by the names they have for them."""

    name: str
    title: str
    claims: list[Claim] = field(default_factory=list)
    scenes: dict[str, Scene] = field(default_factory=dict)
    figures: list[PaperFigure] = field(default_factory=list)
    lines: Lines = field(default_factory=lambda: Lines({}))

    def located(self, index: int, claim: str, error: InputError) -> InputError:
        """The error with the file, the claim and the line of the key that it names."""
        said = error.name.removeprefix(f"claim {claim}").removeprefix(": ")
        key = re.split(r"[^A-Za-z0-9_]", said)[0]
        keys = (key, *_ALSO.get(key, (f"{key}s",)))
        # A key that is missing is looked for beside those that stand for it.
        others = [k for group in _GROUPS if set(keys) & set(group) for k in group]
        lines = self.lines
        line = lines.of("claim", index, *keys, *others)
        if not any(lines.has("claim", index, k) for k in (*keys, *others)):
            shared = [k for k in keys if lines.has("defaults", 0, k)]
            line = lines.of("defaults", 0, *shared) if shared else line
        where = f"{self.name}:{line}: claim {claim}"
        return InputError(f"{where}: {said}" if said else where, error.value, error.problem)


def load_claims(path: Path) -> ClaimsFile:
    """The claims in a TOML file; InputError names the file, the line, the claim and the problem."""
    data = read_toml(path)
    found = ClaimsFile(path.name, "", lines=lines_of(path.read_bytes().decode()))
    tables = data.get("claim")
    if not isinstance(tables, list) or not tables:
        raise InputError("file", path.name, "must hold [[claim]] tables")
    for key in sorted(set(data) - set(_ROOT)):
        at = found.lines.of("", 0, key) if key in found.lines.tables[""][0].keys else (
            found.lines.of(key)
        )  # fmt: skip
        raise InputError(
            f"{path.name}:{at}: {key}", data[key], "unknown; allowed: " + ", ".join(_ROOT)
        )
    found.title = str(data.get("title", path.stem))
    defaults = _defaults(found, data.get("defaults", {}))
    scenes = _Scenes(path, data.get("scene", []), found.lines)
    for index, table in enumerate(tables):
        name = table.get("id") if isinstance(table, dict) else None
        name = name if isinstance(name, str) and name else f"number {index + 1}"
        try:
            _add(found, table, defaults, scenes)
        except ValidationError as error:
            raise found.located(index, name, one_line(error, f"claim {name}")) from None
        except InputError as error:
            raise found.located(index, name, error) from None
    _add_figures(found, data.get("figure", []), scenes)
    return found


def _add_figures(file: ClaimsFile, tables: Any, scenes: "_Scenes") -> None:
    """The figures to be made again, after the claims that they speak of."""
    if not isinstance(tables, list):
        raise InputError(f"{file.name}: figure", tables, "write [[figure]] tables")
    ids = {claim.id for claim in file.claims}
    for index, table in enumerate(tables):
        where = f"{file.name}:{file.lines.of('figure', index)}: figure"
        try:
            figure = PaperFigure.model_validate(table)
            if figure.label in {other.label for other in file.figures}:
                raise InputError("label", figure.label, "stands twice")
            figure.check(scenes.get(figure.scene), ids)
        except ValidationError as error:
            raise one_line(error, where) from None
        except InputError as error:
            raise InputError(f"{where}: {error.name}", error.value, error.problem) from None
        file.figures.append(figure)


def _defaults(file: ClaimsFile, table: Any) -> dict[str, Any]:
    """The keys that claims share; each must be one that some kind of claim has."""
    if not isinstance(table, dict):
        raise InputError(f"{file.name}: defaults", table, "is not a table")
    known = {key for model in KINDS.values() for key in model.model_fields}
    for key in table:
        if key == "id" or key not in known | {*HAMILTONIAN_KEYS, *RUN_KEYS}:
            at = file.lines.of("defaults", 0, key)
            raise InputError(f"{file.name}:{at}: defaults: {key}", table[key], "no claim shares it")
    return table


def _add(file: ClaimsFile, table: Any, defaults: Mapping[str, Any], scenes: "_Scenes") -> None:
    """Adds one claim with its scene, checked as far as that is possible before anything runs."""
    if not isinstance(table, dict):
        raise InputError("", table, "is not a table")
    kind = table.get("kind", defaults.get("kind", ""))
    if not isinstance(kind, str) or kind not in KINDS:
        raise InputError("kind", kind, f"unknown; allowed: {', '.join(KINDS)}")
    model = KINDS[kind]
    if model is TheoremClaim:
        _add_theorem(file, table)
        return
    if "every" in table and kind not in _EVERY_KINDS:
        raise InputError("every", table["every"], f"a claim of kind {kind} speaks of one H; of "
                         f"every H may speak: {', '.join(_EVERY_KINDS)}")  # fmt: skip
    keys = _with_defaults(model, table, defaults)
    hamiltonian_keys = {key: keys.pop(key) for key in HAMILTONIAN_KEYS if key in keys}
    on_runs = issubclass(model, ON_RUNS)
    runs = {key: keys[key] for key in RUN_KEYS if key in keys} if on_runs else {}
    for key in set(runs) - set(model.model_fields):
        del keys[key]
    if "every" in hamiltonian_keys:
        keys["every"] = hamiltonian_keys["every"]
    claim: Claim = model.model_validate(keys)
    _is_new(file, claim)
    if "every" in hamiltonian_keys:
        _check_every(claim, hamiltonian_keys)
    else:
        name, scene = scene_for(claim, hamiltonian_keys, runs, scenes.get)
        _check_one(claim, scene)
        claim = claim.model_copy(update={"scene": name})
        file.scenes.setdefault(name, scene)
    file.claims.append(claim)


def _add_theorem(file: ClaimsFile, table: Mapping[str, Any]) -> None:
    """A claim in words, which has neither scene nor scheme."""
    from verify.claims.theorems import names

    claim = TheoremClaim.model_validate(table)
    _is_new(file, claim)
    if claim.name not in names():
        raise InputError("name", claim.name, f"unknown; allowed: {', '.join(names())}")
    file.claims.append(claim)


def _is_new(file: ClaimsFile, claim: Claim) -> None:
    if claim.id in {other.id for other in file.claims}:
        raise InputError("id", claim.id, "stands twice; each claim has its own")


def _with_defaults(
    model: type[Claim], table: Mapping[str, Any], defaults: Mapping[str, Any]
) -> dict[str, Any]:
    """The claim's keys, with those of the defaults that its kind has and it does not say itself."""
    fields = set(model.model_fields)
    taken = set(fields) | set(HAMILTONIAN_SOURCES) | {"parameters"}
    taken -= set() if "every" in fields else {"every"}
    if issubclass(model, ON_RUNS):
        taken |= set(RUN_KEYS)
        one = issubclass(model, ONE_RUN)
        taken -= {"initial_values"} if one and "q" in defaults else set()
        taken -= {"step_sizes"} if one or "step_size" in fields else set()
        taken -= {"step_size"} if not one and "step_sizes" in defaults else set()
        taken -= {"q", "p"} if not one and "initial_values" in defaults else set()
    for group in _GROUPS:
        taken -= set(group) if set(group) & set(table) else set()
    if not set(HAMILTONIAN_SOURCES) & set(
        table
    ):  # `parameters` alone are of the H that the claims share
        taken |= {key for key in HAMILTONIAN_SOURCES if key != "every" or "every" in fields}
    return {**{key: value for key, value in defaults.items() if key in taken}, **table}


def _check_every(claim: Claim, hamiltonian_keys: Mapping[str, Any]) -> None:
    if others := [key for key in hamiltonian_keys if key != "every"]:
        raise InputError(
            others[0], hamiltonian_keys[others[0]], "says which H, and `every` says every H"
        )
    every_h = schemes.get(claim.scheme).every_h
    if every_h is None:
        raise InputError("scheme", claim.scheme, "is given for one H, not for every H")
    if every_h.separable and hamiltonian_keys["every"] != EVERY_SEPARABLE:
        problem = f"{claim.scheme} takes H = T(p) + V(q) only; say {EVERY_SEPARABLE!r}"
        raise InputError("every", hamiltonian_keys["every"], problem)
    if isinstance(claim, DeltaJClaim):
        if claim.up_to is None:
            raise InputError("up_to", "", "is missing: of every H only the first term is known")
        read_every_formula(claim, claim.formula)


def _check_one(claim: Claim, scene: Scene) -> None:
    """The claim's formulas, and whether its runs are among its scene's."""
    read_formulas(claim, scene.exact_hamiltonian().parameters)
    grid = scene.grid
    if isinstance(claim, GrowthClaim):
        growth_tasks(scene, claim.scheme)
    if grid is None:
        return
    if isinstance(claim, ValueClaim) and len(grid.step_sizes) * len(grid.initial_values) > 1:
        raise InputError("", "", "speaks of one run; give step_size, q and p")
    if isinstance(claim, TableClaim) and len(claim.rows or grid.initial_values) != (
        count := len(grid.initial_values)
    ):
        raise InputError("rows", len(claim.rows or ()), f"give {count}, one an initial value")
    asked = claim.step_sizes if isinstance(claim, TableClaim) else ()
    asked += (claim.step_size,) if isinstance(claim, MagnitudeClaim) else ()
    for h in asked:
        if h not in grid.step_sizes:
            raise InputError("step_size", text(h), "is not in the scene's grid")


class _Scenes:
    """The scenes by name: the file's own `[[scene]]` tables, then the files beside it."""

    def __init__(self, path: Path, tables: Any, lines: Lines) -> None:
        self.folder, self.found = path.parent, dict[str, Scene]()
        if not isinstance(tables, list):
            raise InputError(f"{path.name}: scene", tables, "write [[scene]] tables")
        for index, table in enumerate(tables):
            where = f"{path.name}:{lines.of('scene', index)}: scene"
            name = table.get("name") if isinstance(table, dict) else None
            if not isinstance(name, str) or not name or name in self.found:
                raise InputError(where, name or "", "each [[scene]] has a name of its own")
            self.found[name] = scene_from(table, where)

    def get(self, name: Any) -> Scene:
        if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z0-9_-]{1,80}", name):
            raise InputError("scene", name, "is no name of a scene: letters, digits, _ and -")
        if name not in self.found:
            path = self.folder / f"{name}.toml"
            if not path.is_file():
                raise InputError("scene", name, f"there is no {name}.toml beside the claims file")
            self.found[name] = load_scene(path)
        return self.found[name]
