"""What a caller gives, read: a system, a scheme, exact numbers, lists of them.

A system is a `Hamiltonian`, a `System`, the name of one in any case, or a formula such as
"p**2/2 - cos(q)". A scheme is a name or an alias, formulas 'p_next = …; q_next = …', a splitting
'kick 1/2; drift 1; kick 1/2', a `Scheme`, or a `StepMap` of the same Hamiltonian. Numbers are read
as `verify.arithmetic.exact` tells; numpy's are read like Python's.
"""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from numbers import Integral
from typing import Any

from verify import schemes
from verify.algebra.expressions.formula_text import to_text
from verify.arithmetic.exact import Exact, whole
from verify.errors import InputError, unknown
from verify.execution.execute import Store, execute
from verify.execution.executors import Placement
from verify.execution.study import Need, plan_of
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.named_system import System
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene, scene_from
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme

GivenSystem = Hamiltonian | System | str
GivenScheme = Scheme | StepMap | str
GivenParameters = Mapping[str, Exact | None] | None

_NAME = re.compile(r"[^\W\d]\w*([ -][^\W\d]\w*)*")  # no formula: a word, or words with dashes
_SOURCE = "arguments"
_LEAST = 3  # letters of what is taken for a name; `p` is a formula
_SYSTEM = "is no system; allowed: a name such as duffing, a formula in p and q, a Hamiltonian"
_SCHEME = (
    "is no scheme; allowed: a name such as lie2, 'p_next = …; q_next = …', a Scheme, a StepMap"
)


def hamiltonian_from(system: GivenSystem, parameters: GivenParameters = None) -> Hamiltonian:
    """The Hamiltonian that is meant, with these parameter values beside those that it has.

    Raises InputError for what is no system, an unknown name, a bad formula or parameter.

    >>> hamiltonian_from("Duffing", {"delta": 0.1}).texts
    {'hamiltonian': 'delta*q**4/4 + p**2/2 + q**2/2', 'parameters': {'delta': '0.1'}}
    """
    if parameters is not None and not isinstance(parameters, Mapping):
        raise InputError("parameters", parameters, "is not a mapping of names to values")
    if isinstance(system, Hamiltonian):
        values = {**dict(system.values), **(parameters or {})}
        return system.with_values(values) if parameters else system
    if isinstance(system, System):
        return system.hamiltonian(parameters)
    if not isinstance(system, str):
        raise InputError("system", system, _SYSTEM)
    name = systems.canonical(system)
    if name in systems.names():
        return systems.get(name).hamiltonian(parameters)
    if len(system.strip()) >= _LEAST and _NAME.fullmatch(system.strip()):
        raise unknown("system", system, systems.names(), "; or a formula in p and q")
    return Hamiltonian.parse(system, parameters)


def scheme_from(scheme: GivenScheme) -> Scheme | StepMap:
    """The scheme that is meant, or the step map as it is; InputError for what is neither."""
    if isinstance(scheme, Scheme | StepMap):
        return scheme
    if not isinstance(scheme, str):
        more = "; verify.check takes a step function" if callable(scheme) else ""
        raise InputError("scheme", scheme, _SCHEME + more)
    return schemes.get(scheme)


def scheme_name(scheme: GivenScheme, hamiltonian: Hamiltonian) -> str:
    """A text by which `schemes.get` finds the scheme; that of a map has its formulas.

    Raises InputError for a step map of another H, or without a closed form.
    """
    found = scheme_from(scheme)
    if isinstance(found, Scheme):
        try:
            known = schemes.get(found.name)
        except InputError:
            known = None
        if known == found:
            return found.name
    step_map = step_map_from(found, hamiltonian)
    return f"p_next = {to_text(step_map.p_next)}; q_next = {to_text(step_map.q_next)}"


def step_map_from(scheme: Scheme | StepMap, hamiltonian: Hamiltonian) -> StepMap:
    """The scheme's map of H. Raises InputError for a step map of another H."""
    if isinstance(scheme, Scheme):
        return scheme.step_map(hamiltonian)
    own = scheme.hamiltonian
    if own.exact != hamiltonian.exact:
        problem = "is that of the step map, and not the one that is asked for"
        raise InputError("hamiltonian", to_text(own.exact), problem)
    return scheme


def schemes_from(given: object, hamiltonian: Hamiltonian) -> list[str]:
    """The names of one scheme or of several."""
    return [scheme_name(each, hamiltonian) for each in listed("scheme", given)]


def is_list(given: object) -> bool:
    """Whether it holds several: a list, a tuple, a range, an array."""
    return (isinstance(given, Sequence | range) and not isinstance(given, str | bytes)) or (
        type(given).__module__ == "numpy" and getattr(given, "ndim", 0) == 1
    )


def listed(name: str, given: Any) -> list[Any]:
    """Several values as a list; one alone is a list of one. InputError for an empty list."""
    found = list(given) if is_list(given) else [given]
    if not found:
        raise InputError(name, "[]", "is empty; give one at least")
    return found


def plain(given: Any) -> Any:
    """The same of Python's own numbers and lists, as a scene takes them."""
    if isinstance(given, Mapping):
        return {key: plain(x) for key, x in given.items()}
    if is_list(given):
        return [plain(x) for x in given]
    whole = isinstance(given, Integral) and not isinstance(given, bool)
    return int(given) if whole else given


def scene_of(
    system: GivenSystem,
    scheme: object,
    parameters: GivenParameters,
    *,
    t0: Exact | None = None,
    name: str = "",
    known_as: str | None = None,
    **sections: Any,
) -> Scene:
    """A scene of the system and one scheme or several with these sections, and a name to show.

    `t0`: when its runs start, which an H without t does not look at. `known_as`: the name of the
    system, where it has one.
    """
    exact = hamiltonian_from(system, parameters)
    of_family = known_as is not None and systems.get(known_as).family is not None
    data = {
        **({"system": known_as} if known_as else {"hamiltonian": exact.formula}),
        "parameters": dict[str, Fraction](exact.values)
        | ({"n": Fraction(exact.degrees)} if of_family else {}),
        "schemes": schemes_from(scheme, exact),
        **({"t0": plain(t0)} if t0 is not None and exact.time_dependent else {}),
    }
    sections = {key: plain(_without_none(given)) for key, given in sections.items()}
    try:
        return scene_from({**data, **sections}, _SOURCE, default_name=name)
    except InputError as error:
        raise type(error)(_argument(error.name), error.value, error.problem) from None


def _argument(key: str) -> str:
    """The argument that a scene's key is made of.

    >>> _argument("arguments: flow.0.step_size: step_size"), _argument("arguments: flow.0.scale")
    ('step_size', 'scale')
    """
    path, _, own = key.removeprefix(f"{_SOURCE}: ").partition(": ")
    last = [part for part in path.split(".") if not part.isdecimal()][-1]
    return own if own and own != "number" else last


def _without_none(given: Any) -> Any:
    """Sections without the keys that were left out."""
    if isinstance(given, Mapping):
        return {key: x for key, x in given.items() if x is not None}
    return [_without_none(each) for each in given] if isinstance(given, list) else given


def performed(scene: Scene, need: Need, workers: int) -> dict[str, Frozen]:
    """The results of what the scene needs, in so many processes; 1 is this one."""
    where = Placement(whole("workers", workers, 1))
    return execute(plan_of([scene], need), Store(None), where=where)
