"""The file that holds claims, in TOML: read, and every error said with its line.

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

`title` names the whole; `about` lines say what it is, before all else, and `[[left_out]]` tables
name with `what` and `why` what of the paper is not claimed. See `verify.claims.readings` for claims
See `verify.claims.kinds` for the kinds, `verify.claims.scenes` for what a claim may speak of,
`verify.scenes.paper_figures` for `[[figure]]`, and `verify.scenes.causes` for `[[cause]]`. A scene
that a claim names is a `[[scene]]` of this file, or the file of that name beside it.
"""

import re
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from verify.claims.claim import Claim, outside
from verify.claims.kinds import models
from verify.claims.on_runs import RunKeys
from verify.claims.quantified import QuantifiedClaim
from verify.claims.readings import settled
from verify.claims.scenes import HAMILTONIAN_KEYS, HAMILTONIAN_SOURCES, NamedScenes, scene_for
from verify.errors import NOT_GIVEN, InputError, LimitError, unknown
from verify.files import read_text
from verify.prose import read_prose
from verify.scenes.causes import Cause
from verify.scenes.mistakes.values import one_line
from verify.scenes.paper_figures import PaperFigure
from verify.scenes.scene import Scene
from verify.scenes.toml_file import Lines, lines_of, read_toml, tables_of

_ROOT = ("title", "about", "defaults", "scene", "claim", "cause", "figure", "left_out")
# Of each group a claim needs one: where it gives one itself, it takes none from the defaults.
_GROUPS = (
    HAMILTONIAN_KEYS,
    ("time", "steps"),
    ("step_size", "step_sizes"),
    ("q", "p", "initial_values"),
    ("printed", "lg_printed", "rows"),
)
_ALSO = {"parameter": ("parameters",), "step_size": ("step_sizes",), "number": ()}


@dataclass
class ClaimsFile:
    """The claims in their order, with the scenes they speak of by the names they have for them.

    `about`: what a report says before all else; `left_out`: what is not claimed of it, and why.
    """

    name: str
    title: str
    about: tuple[str, ...] = ()
    left_out: tuple[tuple[str, str], ...] = ()
    claims: list[Claim] = field(default_factory=list)
    scenes: dict[str, Scene] = field(default_factory=dict)
    causes: list[Cause] = field(default_factory=list)
    figures: list[PaperFigure] = field(default_factory=list)
    lines: Lines = field(default_factory=lambda: Lines({}))

    def warnings(self, claims: Collection[Claim]) -> list[str]:
        """What readers may take amiss of these claims, one line each, with its place."""
        return [
            f"{self.name}:{self.lines.of('claim', k, 'kind')}: claim {claim.id}: {claim.warning}"
            for k, claim in enumerate(self.claims)
            if claim.warning and claim in claims
        ]

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
        return type(error)(f"{where}: {said}" if said else where, error.value, error.problem)


def load_claims(path: Path) -> ClaimsFile:
    """The claims in a TOML file; InputError names the file, the line, the claim and the problem."""
    data = read_toml(path)
    found = ClaimsFile(path.name, "", lines=lines_of(read_text(path)))
    tables = data.get("claim")
    if not isinstance(tables, list) or not tables:
        raise InputError(
            "file", path.name, "must hold [[claim]] tables; a scene goes with verify report"
        )
    for key in sorted(set(data) - set(_ROOT)):
        at = found.lines.of("", 0, key) if key in found.lines.tables[""][0].keys else (
            found.lines.of(key)
        )  # fmt: skip
        raise InputError(
            f"{path.name}:{at}: {key}", data[key], "unknown; allowed: " + ", ".join(_ROOT)
        )
    found.title = str(data.get("title", path.stem))
    found.about = _texts(found, "about", data.get("about", []))
    found.left_out = _left_out(found, data.get("left_out", []))
    defaults = _defaults(found, data.get("defaults", {}))
    scenes = NamedScenes(path, data.get("scene", []), found.lines)
    for index, table in enumerate(tables):
        name = table.get("id") if isinstance(table, dict) else None
        name = name if isinstance(name, str) and name else f"number {index + 1}"
        try:
            _add(found, table, defaults, scenes)
        except (ValidationError, InputError) as error:
            said = error if isinstance(error, InputError) else one_line(error, f"claim {name}")
            told = found.located(index, name, said)
            if not isinstance(told, LimitError):
                raise told from None
            _append(found, outside({**defaults, **table}, str(told)))
    _settle_readings(found)
    _add_causes(found, data.get("cause", []))
    _add_figures(found, data.get("figure", []), scenes)
    return found


def _texts(file: ClaimsFile, key: str, given: Any) -> tuple[str, ...]:
    """A list of texts under a key of the file itself."""
    if not isinstance(given, list) or not all(isinstance(text, str) for text in given):
        at = file.lines.of("", 0, key)
        raise InputError(f"{file.name}:{at}: {key}", given, "is not a list of texts")
    return tuple(given)


def _left_out(file: ClaimsFile, tables: Any) -> tuple[tuple[str, str], ...]:
    """What is not claimed, each with the reason."""
    for index, table in enumerate(tables_of(file.name, "left_out", tables)):
        if not isinstance(table, dict) or set(table) != {"what", "why"}:
            at = file.lines.of("left_out", index)
            raise InputError(f"{file.name}:{at}: left_out", table, "has `what` and `why`, both")
    return tuple((str(table["what"]), str(table["why"])) for table in tables)


def _settle_readings(file: ClaimsFile) -> None:
    """Each reading with the texts of its statement; in a second pass, for it may stand later."""
    found = []
    for index, claim in enumerate(file.claims):
        try:
            found.append(settled(file.claims, index))
        except InputError as error:
            raise file.located(index, claim.id, error) from None
    file.claims = found


def _add_causes(file: ClaimsFile, tables: Any) -> None:
    """What explains several statements, after the claims that it speaks of."""
    ids = {claim.id for claim in file.claims}
    statements = {claim.reading_of for claim in file.claims if claim.reading_of}
    for index, table in enumerate(tables_of(file.name, "cause", tables)):
        with _named(f"{file.name}:{file.lines.of('cause', index)}: cause"):
            says = table.get("says") if isinstance(table, dict) else None
            if not isinstance(says, str) or not says:
                raise InputError("says", says or NOT_GIVEN, "is a sentence; none stands here")
            cause = Cause.model_validate({**table, "says": read_prose(says)})
            cause.check(statements, ids)
            file.causes.append(cause)


@contextmanager
def _named(where: str) -> Iterator[None]:
    """Says of an error in a table of the file where it stands."""
    try:
        yield
    except ValidationError as error:
        raise one_line(error, where) from None
    except InputError as error:
        raise InputError(f"{where}: {error.name}", error.value, error.problem) from None


def _add_figures(file: ClaimsFile, tables: Any, scenes: NamedScenes) -> None:
    """The figures to be made again, after the claims that they speak of."""
    ids = {claim.id for claim in file.claims}
    for index, table in enumerate(tables_of(file.name, "figure", tables)):
        with _named(f"{file.name}:{file.lines.of('figure', index)}: figure"):
            figure = PaperFigure.model_validate(table)
            if figure.label in {other.label for other in file.figures}:
                raise InputError("label", figure.label, "stands twice")
            figure.check(scenes.get(figure.scene), ids)
        file.figures.append(figure)


def _defaults(file: ClaimsFile, table: Any) -> dict[str, Any]:
    """The keys that claims share; each must be one that some kind of claim has."""
    if not isinstance(table, dict):
        raise InputError(f"{file.name}: defaults", table, "is not a table")
    known = {key for model in models().values() for key in model.model_fields}
    for key in table:
        if key == "id" or key not in known | {*HAMILTONIAN_KEYS, *RunKeys.model_fields}:
            at = file.lines.of("defaults", 0, key)
            raise InputError(f"{file.name}:{at}: defaults: {key}", table[key], "no claim shares it")
    return table


def _add(file: ClaimsFile, table: Any, defaults: Mapping[str, Any], scenes: NamedScenes) -> None:
    """Adds one claim with its scene, checked as far as that is possible before anything runs."""
    if not isinstance(table, dict):
        raise InputError("", table, "is not a table")
    kind = table.get("kind", defaults.get("kind", ""))
    if not isinstance(kind, str) or kind not in models():
        raise unknown("kind", kind, models())
    model = models()[kind]
    if not model.on_scene:
        _append(file, model.model_validate(table))
        return
    if "every" in table and not issubclass(model, QuantifiedClaim):
        quantified = [k for k, m in models().items() if issubclass(m, QuantifiedClaim)]
        raise InputError("every", table["every"], f"a claim of kind {kind} speaks of one H; of "
                         f"every H may speak: {', '.join(quantified)}")  # fmt: skip
    keys = _with_defaults(model, table, defaults)
    hamiltonian_keys = {key: keys.pop(key) for key in HAMILTONIAN_KEYS if key in keys}
    runs = {key: keys[key] for key in model.run_keys if key in keys}
    for key in set(runs) - set(model.model_fields):
        del keys[key]
    if "every" in hamiltonian_keys:
        keys["every"] = hamiltonian_keys["every"]
    claim = model.model_validate(keys)
    if isinstance(claim, QuantifiedClaim) and claim.every:
        _of_every_alone(hamiltonian_keys)
        claim.check_every()
        _append(file, claim)
        return
    name, scene = scene_for(claim, hamiltonian_keys, runs, scenes.get)
    claim.check_scene(scene)
    _append(file, claim.model_copy(update={"scene": name}))
    file.scenes.setdefault(name, scene)


def _append(file: ClaimsFile, claim: Claim) -> None:
    if claim.id in {other.id for other in file.claims}:
        raise InputError("id", claim.id, "stands twice; each claim has its own")
    file.claims.append(claim)


def _of_every_alone(hamiltonian_keys: Mapping[str, Any]) -> None:
    for key in hamiltonian_keys:
        if key != "every":
            problem = "says which H, and `every` says every H"
            raise InputError(key, hamiltonian_keys[key], problem)


def _with_defaults(
    model: type[Claim], table: Mapping[str, Any], defaults: Mapping[str, Any]
) -> dict[str, Any]:
    """The claim's keys, with those of the defaults that its kind has and it does not say itself."""
    fields = set(model.model_fields)
    taken = set(fields) | set(HAMILTONIAN_SOURCES) | {"parameters"}
    taken -= set() if "every" in fields else {"every"}
    if model.run_keys:
        one = model.one_run
        taken |= set(model.run_keys)
        taken -= {"initial_values"} if one and "q" in defaults else set()
        taken -= {"step_sizes"} if one or "step_size" in fields else set()
        taken -= {"step_size"} if not one and "step_sizes" in defaults else set()
        taken -= {"q", "p"} if not one and "initial_values" in defaults else set()
    for group in _GROUPS:
        taken -= set(group) if set(group) & set(table) else set()
    # `parameters` alone are of the H that the claims share.
    if not set(HAMILTONIAN_SOURCES) & set(table):
        taken |= {key for key in HAMILTONIAN_SOURCES if key != "every" or "every" in fields}
    return {**{key: value for key, value in defaults.items() if key in taken}, **table}
