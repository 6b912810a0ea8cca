"""The reader of claims files in TOML, which reports each error with its line.

    title = "A paper"

    [defaults]                      # keys that claims share, where they do not say otherwise
    scheme = "lie2"
    hamiltonian = "p**2/2 - cos(q)"

    [[claim]]
    id = "eq-3"
    source = "Eq. 3"                # these three may be left out
    section = "2 The scheme"         # a report groups the claims by it
    statement = "ΔJ is of order `h^3`."   # a formula stands between backticks
    kind = "defect_order"
    defect_order = 3

`title` names the whole. See `verify.claims.statement_readings` for readings of one statement and
for repairs, `verify.claims.kinds` for the kinds, `verify.claims.claim_scenes` for what a claim may
speak of, and `verify.claims.paper_file` for what else a file may say of its paper. A scene that a
claim names is a `[[scene]]` of this file, or the file of that name beside it; a report shows the
scenes of `report_scenes = ["NAME", …]`, by default these.
"""

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from verify.claims.base_claim import Claim, outside
from verify.claims.claim_scenes import HAMILTONIAN_KEYS, HAMILTONIAN_SOURCES, NamedScenes, scene_for
from verify.claims.kinds import models
from verify.claims.paper_file import TABLES, PaperFile, errors_located_at
from verify.claims.quantified_claims import FamilyClaim
from verify.claims.run_claims import RunKeys
from verify.claims.statement_readings import check_repair, settle_reading
from verify.errors import InputError, LimitError, unknown_name
from verify.files import read_text
from verify.scenes.model_mistakes import describe_first_error
from verify.scenes.scene import Scene
from verify.scenes.toml_file import check_kind, lines_of, read_toml

_ROOT = ("title", "defaults", "scene", "report_scenes", "claim", *TABLES)
# A claim needs one key of each group. If it gives one itself, it takes none of that group from the
# defaults: `steps` of a claim would otherwise contradict a shared `time`.
_GROUPS = (
    HAMILTONIAN_KEYS,
    ("time", "steps"),
    ("step_size", "step_sizes"),
    ("q", "p", "initial_values"),
    ("printed", "lg_printed", "rows"),
)
# Errors name single values, which may stand in the file under a plural key; `number` stands under
# none, and must not be looked up as `numbers`.
_ALSO = {"parameter": ("parameters",), "step_size": ("step_sizes",), "number": ()}


@dataclass
class ClaimsFile(PaperFile):
    """The claims in their order, with their scenes by the names that the claims use.

    `report_scenes`: those that a report of the file shows by themselves.
    """

    claims: list[Claim] = field(default_factory=list)
    scenes: dict[str, Scene] = field(default_factory=dict)
    report_scenes: list[Scene] = field(default_factory=list)

    def warnings(self, claims: Collection[Claim]) -> list[str]:
        """Return a line with its place for each claim that readers may misunderstand."""
        line_of = self.lines.line_of
        return [
            f"{self.name}:{line_of('claim', k, 'kind')}: claim {claim.id}: {claim.warning}"
            for k, claim in enumerate(self.claims)
            if claim.warning and claim in claims
        ]

    def locate_error(self, index: int, claim: str, error: InputError) -> InputError:
        """Return the error with the file, the claim and the line of the key that it names."""
        error_name = error.name.removeprefix(f"claim {claim}").removeprefix(": ")
        key = re.split(r"[^A-Za-z0-9_]", error_name)[0]
        keys = (key, *_ALSO.get(key, (f"{key}s",)))
        # A key that is missing is looked for beside those that stand for it.
        stand_ins = [k for group in _GROUPS if set(keys) & set(group) for k in group]
        lines = self.lines
        line = lines.line_of("claim", index, *keys, *stand_ins)
        if not any(lines.has("claim", index, k) for k in (*keys, *stand_ins)):
            shared = [k for k in keys if lines.has("defaults", 0, k)]
            line = lines.line_of("defaults", 0, *shared) if shared else line
        place = f"{self.name}:{line}: claim {claim}"
        return type(error)(
            f"{place}: {error_name}" if error_name else place, error.value, error.problem
        )


def load_claims(path: Path) -> ClaimsFile:
    """Read the claims in a TOML file; InputError names file, line, claim and problem."""
    data = read_toml(path)
    check_kind(data, "claim", path.name)
    file = ClaimsFile(path.name, "", lines=lines_of(read_text(path)))
    tables = data.get("claim")
    if not isinstance(tables, list) or not tables:
        raise InputError("file", path.name, "must hold [[claim]] tables")
    # Sorted, so that the error does not depend on the order of a set.
    for key in sorted(set(data) - set(_ROOT)):
        line = file.lines.line_of("", 0, key) if key in file.lines.tables[""][0].keys else (
            file.lines.line_of(key)
        )  # fmt: skip
        raise InputError(
            f"{path.name}:{line}: {key}", data[key], "unknown; allowed: " + ", ".join(_ROOT)
        )
    file.title = str(data.get("title", path.stem))
    defaults = _defaults(file, data.get("defaults", {}))
    scenes = NamedScenes(path, data.get("scene", []), file.lines)
    for index, table in enumerate(tables):
        name = table.get("id") if isinstance(table, dict) else None
        name = name if isinstance(name, str) and name else f"number {index + 1}"
        try:
            _add(file, table, defaults, scenes)
        except (ValidationError, InputError) as error:
            input_error = (
                error
                if isinstance(error, InputError)
                else describe_first_error(error, f"claim {name}")
            )
            located_error = file.locate_error(index, name, input_error)
            # A claim beyond the limits is kept as undecided; every other error ends the reading.
            if not isinstance(located_error, LimitError):
                raise located_error from None
            _append(file, outside({**defaults, **table}, str(located_error)))
    _settle_all_readings(file)
    file.add_tables(data, file.claims, scenes.get)
    names = file.texts("report_scenes", data.get("report_scenes", [*scenes.scenes]))
    line = file.lines.line_of("", 0, "report_scenes")
    with errors_located_at(f"{path.name}:{line}: report_scenes"):
        file.report_scenes = [scenes.get(name) for name in names]
    return file


def _settle_all_readings(file: ClaimsFile) -> None:
    """Give each reading the texts of its statement.

    This is a second pass over the claims: whether statements are counted at all depends on claims
    that may stand later in the file.
    """
    claims = []
    for index, claim in enumerate(file.claims):
        try:
            claims.append(settle_reading(file.claims, index))
            check_repair(claims[-1], file.claims)
        except InputError as error:
            raise file.locate_error(index, claim.id, error) from None
    file.claims = claims


def _defaults(file: ClaimsFile, table: Any) -> dict[str, Any]:
    """Check the keys that claims share; each must be a key of some kind of claim."""
    if not isinstance(table, dict):
        raise InputError(f"{file.name}: defaults", table, "is not a table")
    claim_keys = {key for model in models().values() for key in model.model_fields}
    for key in table:
        if key == "id" or key not in claim_keys | {*HAMILTONIAN_KEYS, *RunKeys.model_fields}:
            line = file.lines.line_of("defaults", 0, key)
            raise InputError(
                f"{file.name}:{line}: defaults: {key}", table[key], "no claim shares it"
            )
    return table


def _add(file: ClaimsFile, table: Any, defaults: Mapping[str, Any], scenes: NamedScenes) -> None:
    """Add one claim with its scene, checked as far as possible before anything runs."""
    if not isinstance(table, dict):
        raise InputError("", table, "is not a table")
    kind = table.get("kind", defaults.get("kind", ""))
    if not isinstance(kind, str) or kind not in models():
        raise unknown_name("kind", kind, models())
    model = models()[kind]
    if not model.on_scene:
        _append(file, model.model_validate(table))
        return
    if "every" in table and not issubclass(model, FamilyClaim):
        quantified = [k for k, m in models().items() if issubclass(m, FamilyClaim)]
        raise InputError("every", table["every"], f"a claim of kind {kind} speaks of one H; of "
                         f"every H may speak: {', '.join(quantified)}")  # fmt: skip
    keys = _with_defaults(model, table, defaults)
    hamiltonian_keys = {key: keys.pop(key) for key in HAMILTONIAN_KEYS if key in keys}
    runs = {key: keys[key] for key in model.run_keys if key in keys}
    # The keys of runs that are no fields of the model were moved into `runs`; pydantic would refuse
    # them as unknown keys.
    for key in set(runs) - set(model.model_fields):
        del keys[key]
    if "every" in hamiltonian_keys:
        keys["every"] = hamiltonian_keys["every"]
    claim = model.model_validate(keys)
    if isinstance(claim, FamilyClaim) and claim.every:
        for key, value in hamiltonian_keys.items():
            if key != "every":
                raise InputError(key, value, "says which H, and `every` says every H")
        claim.check_every()
        _append(file, claim)
        return
    claim, scene = scene_for(claim, hamiltonian_keys, runs, scenes.get)
    claim.check_scene(scene)
    _append(file, claim)
    # Several claims may share one scene, which is then stored once, under its name.
    file.scenes.setdefault(claim.scene, scene)


def _append(file: ClaimsFile, claim: Claim) -> None:
    if claim.id in {other.id for other in file.claims}:
        raise InputError("id", claim.id, "stands twice; each claim has its own")
    file.claims.append(claim)


def _with_defaults(
    model: type[Claim], table: Mapping[str, Any], defaults: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the claim's keys, completed by the defaults that apply to its kind."""
    fields = set(model.model_fields)
    keys = set(fields) | set(HAMILTONIAN_SOURCES) | {"parameters", "split"}
    keys -= set() if "every" in fields else {"every"}
    if model.run_keys:
        # Of the defaults a claim on one run prefers single values, and other claims prefer lists.
        is_of_one_run = model.one_run
        keys |= set(model.run_keys)
        keys -= {"initial_values"} if is_of_one_run and "q" in defaults else set()
        keys -= {"step_sizes"} if is_of_one_run or "step_size" in fields else set()
        keys -= {"step_size"} if not is_of_one_run and "step_sizes" in defaults else set()
        keys -= {"q", "p"} if not is_of_one_run and "initial_values" in defaults else set()
    for group in _GROUPS:
        keys -= set(group) if set(group) & set(table) else set()
    # `parameters` alone are of the H that the claims share.
    if not set(HAMILTONIAN_SOURCES) & set(table):
        keys |= {key for key in HAMILTONIAN_SOURCES if key != "every" or "every" in fields}
    return {**{key: value for key, value in defaults.items() if key in keys}, **table}
