"""Arguments of callers in their several forms: a system, a scheme, exact numbers, lists.

A system is a `Hamiltonian`, a `System`, the name of a system in any case, a formula such as
"p**2/2 - cos(q)", or equations "u_dot = …; v_dot = …" where what is asked for takes them. A scheme
is a name or an alias, formulas 'p_next = …; q_next = …', a splitting 'kick 1/2; drift 1; kick 1/2',
a `Scheme`, or a `StepMap` of the same Hamiltonian. Numbers are read as `verify.arithmetic.exact`
describes; those of numpy are read like those of Python.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from numbers import Integral
from typing import Any

from verify import schemes
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import Number, whole
from verify.errors import InputError, unknown_name
from verify.execution.execute import Store, execute
from verify.execution.executors import Placement
from verify.execution.plan import Need, plan_of
from verify.hamiltonians import systems
from verify.hamiltonians.equations import Equations, read_system
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import System
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene, scene_from
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme
from verify.structures.reading import KeepsRequest

SystemLike = Hamiltonian | System | str
SchemeLike = Scheme | StepMap | str
SchemesLike = SchemeLike | Sequence[SchemeLike]
# One number, or a list, a tuple, a range or an array with one axis of numbers.
NumbersLike = Number | Iterable[Number]
# Values by the names of parameters; None leaves a parameter a symbol.
ParametersLike = Mapping[str, Number | None] | None
Texts = str | Sequence[str]

# A word, or words with dashes or blanks between them: rather a name than a formula.
_NAME_PATTERN = re.compile(r"[^\W\d]\w*([ -][^\W\d]\w*)*")
_MIN_NAME_LETTERS = 3  # a shorter word, such as p, is a formula
_SOURCE = "arguments"  # the file of the scene, in its errors
_NO_SYSTEM = "is no system; allowed: a name such as duffing, a formula in p and q, a Hamiltonian"
_NO_SCHEME = (
    "is no scheme; allowed: a name such as lie2, 'p_next = …; q_next = …', a Scheme, a StepMap"
)


def hamiltonian_from(
    system: SystemLike, parameters: ParametersLike = None, *, takes_field: bool = False
) -> Hamiltonian:
    """Return the Hamiltonian of a system, with these values of parameters added to its own.

    `takes_field`: it may be equations without an H, as 'u_dot = …; v_dot = …'.
    Raises InputError for a value that is no system, an unknown name, a bad formula or parameter.

    >>> hamiltonian_from("Duffing", {"delta": 0.1}).texts
    {'hamiltonian': 'delta*q**4/4 + p**2/2 + q**2/2', 'parameters': {'delta': '0.1'}}
    """
    if parameters is not None and not isinstance(parameters, Mapping):
        raise InputError("parameters", parameters, "is not a mapping of names to values")
    result = _read(system, parameters)
    if isinstance(result, Equations) and not takes_field:
        problem = "has no H, which is needed here; verify.prove takes it, with keeps=[…]"
        raise InputError("system", result.formula, problem)
    return result


def _read(system: SystemLike, parameters: ParametersLike) -> Hamiltonian:
    if isinstance(system, Hamiltonian):
        values = {**dict(system.values), **(parameters or {})}
        return system.with_values(values) if parameters else system
    if isinstance(system, System):
        return system.hamiltonian(parameters)
    if not isinstance(system, str):
        raise InputError("system", system, _NO_SYSTEM)
    name = systems.canonical(system)
    if name in systems.names():
        return systems.get(name).hamiltonian(parameters)
    # A longer word that names no system is mistyped; as a formula it would be a single parameter.
    if len(system.strip()) >= _MIN_NAME_LETTERS and _NAME_PATTERN.fullmatch(system.strip()):
        raise unknown_name("system", system, systems.names(), "; or a formula in p and q")
    return read_system(system, parameters)


def scheme_from(scheme: SchemeLike) -> Scheme | StepMap:
    """Return the scheme that the value names or is, or the step map. InputError otherwise."""
    if isinstance(scheme, Scheme | StepMap):
        return scheme
    if not isinstance(scheme, str):
        hint = "; verify.check takes a step function" if callable(scheme) else ""
        raise InputError("scheme", scheme, _NO_SCHEME + hint)
    return schemes.get(scheme)


def scheme_name(scheme: SchemeLike, hamiltonian: Hamiltonian) -> str:
    """Return a text by which `schemes.get` finds the scheme: its name, or the formulas of its map.

    Raises InputError for a step map of another H, or without a closed form.
    """
    scheme_or_map = scheme_from(scheme)
    if isinstance(scheme_or_map, Scheme):
        try:
            registered = schemes.get(scheme_or_map.name)
        except InputError:
            registered = None
        # A user's Scheme may bear a catalogue's name with other formulas; then the formulas count.
        if registered == scheme_or_map:
            return scheme_or_map.name
    step_map = step_map_from(scheme_or_map, hamiltonian)
    return f"p_next = {to_text(step_map.p_next)}; q_next = {to_text(step_map.q_next)}"


def step_map_from(scheme: Scheme | StepMap, hamiltonian: Hamiltonian) -> StepMap:
    """Return the scheme's map for H, or the step map itself. InputError if it is for another H."""
    if isinstance(scheme, Scheme):
        return scheme.step_map(hamiltonian)
    map_hamiltonian = scheme.hamiltonian
    if map_hamiltonian.exact != hamiltonian.exact:
        problem = "is that of the step map, and not the one that is asked for"
        raise InputError("hamiltonian", to_text(map_hamiltonian.exact), problem)
    return scheme


def schemes_from(values: object, hamiltonian: Hamiltonian) -> list[str]:
    """Return the names of one scheme or of several, as `scheme_name` does."""
    return [scheme_name(each, hamiltonian) for each in as_list("scheme", values)]


def is_list(value: object) -> bool:
    """Return True if the value is a list, a tuple, a range or an array with one axis."""
    # An array is recognized by its module's name: numpy is not imported for callers without it.
    return (isinstance(value, Sequence | range) and not isinstance(value, str | bytes)) or (
        type(value).__module__ == "numpy" and getattr(value, "ndim", 0) == 1
    )


def texts_from(name: str, values: Texts) -> tuple[str, ...]:
    """Return one text or several. InputError for anything else."""
    texts = [values] if isinstance(values, str) else values
    if not isinstance(texts, Sequence) or not all(isinstance(text, str) for text in texts):
        raise InputError(name, values, "is no text, and no list of texts")
    return tuple(texts)


def names_from(name: str, values: Texts | None) -> str | None:
    """Return names, in a text or a list of texts, as a text with commas; None for None."""
    return None if values is None else ",".join(texts_from(name, values))


def keeps_request(
    keeps: Texts, form: str = "", density: str = "", poisson: str = "", casimirs: Texts = (),
    reverses: str = "", factor: str = "",
) -> KeepsRequest:  # fmt: skip
    """Return the request for these structures, refined so. Raises InputError."""
    names, brackets = texts_from("keeps", keeps), texts_from("casimirs", casimirs)
    return KeepsRequest(names, form, density, poisson, brackets, reverses, factor)


def as_list(name: str, value: Any) -> list[Any]:
    """Return the values as a list, and one value as a list of it. InputError for an empty list."""
    values = list(value) if is_list(value) else [value]
    if not values:
        raise InputError(name, "[]", "is empty; give one at least")
    return values


def plain_values(value: Any) -> Any:
    """Return the value with Python's own whole numbers and lists, as a scene needs them."""
    if isinstance(value, Mapping):
        return {key: plain_values(x) for key, x in value.items()}
    if is_list(value):
        return [plain_values(x) for x in value]
    is_whole = isinstance(value, Integral) and not isinstance(value, bool)
    return int(value) if is_whole else value


def scene_of(
    system: SystemLike,
    scheme: object,
    parameters: ParametersLike,
    *,
    t0: Number | None = None,
    name: str = "",
    system_name: str | None = None,
    **sections: Any,
) -> Scene:
    """Return a scene of the system and one scheme or several, with these sections and this name.

    `t0`: the start time of its runs, which is ignored if H does not depend on t. `system_name`: the
    name of the system, if it has one.
    """
    hamiltonian = hamiltonian_from(system, parameters)
    # A family such as `fput` has one system for each n, and a scene has n as a parameter.
    is_of_family = system_name is not None and systems.get(system_name).family is not None
    data = {
        **({"system": system_name} if system_name else {"hamiltonian": hamiltonian.formula}),
        "parameters": dict[str, Fraction](hamiltonian.values)
        | ({"n": Fraction(hamiltonian.degrees)} if is_of_family else {}),
        "schemes": schemes_from(scheme, hamiltonian),
        **({"t0": plain_values(t0)} if t0 is not None and hamiltonian.time_dependent else {}),
    }
    sections = {key: plain_values(_drop_none(section)) for key, section in sections.items()}
    try:
        return scene_from({**data, **sections}, _SOURCE, default_name=name)
    except InputError as error:
        # The error names a key of the scene, but the caller knows only arguments.
        raise type(error)(_argument_name(error.name), error.value, error.problem) from None


def _argument_name(key: str) -> str:
    """Return the argument whose value has become this key of the scene.

    >>> _argument_name("arguments: flow.0.step_size: step_size")
    'step_size'
    >>> _argument_name("arguments: flow.0.scale")
    'scale'
    """
    path, _, field = key.removeprefix(f"{_SOURCE}: ").partition(": ")
    last_key = [part for part in path.split(".") if not part.isdecimal()][-1]
    return field if field and field != "number" else last_key


def _drop_none(value: Any) -> Any:
    """Return a section, or a list of sections, without the keys whose value is None."""
    if isinstance(value, Mapping):
        return {key: x for key, x in value.items() if x is not None}
    return [_drop_none(each) for each in value] if isinstance(value, list) else value


def perform(scene: Scene, need: Need, workers: int) -> dict[str, Frozen]:
    """Compute the scene's results, by their keys, in `workers` processes; 1 means this process."""
    processes = Placement(whole("workers", workers, 1))
    return execute(plan_of([scene], need), Store(None), where=processes)
