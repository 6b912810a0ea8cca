"""What a claim speaks of: its own Hamiltonian and runs, made into a scene for it.

Keys that say of which H: one of `scene`, `system`, `hamiltonian`, `every`, with `parameters`. Keys
that say of which runs: `step_size` or `step_sizes`, `time` or `steps`, `q` and `p` or
`initial_values`, and `digits`. What a claim on a named scene does not say of its runs is the
scene's.
"""

from collections.abc import Callable, Mapping
from typing import Any

from pydantic import Field

from verify.claims.kinds import (
    BoundedClaim,
    Claim,
    CriteriaClaim,
    FlowClaim,
    GrowthClaim,
    LessClaim,
    MagnitudeClaim,
    MonotoneClaim,
    SpreadClaim,
    TableClaim,
    ValueClaim,
)
from verify.claims.runs import NEEDS
from verify.errors import InputError
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Grid, Scene
from verify.scenes.values import (
    AUTO,
    CLOSED_FORM,
    Digits,
    InitialValue,
    Number,
    Steps,
    StepSize,
    Time,
)
from verify.studies.regions.plan import maps_of

HAMILTONIAN_SOURCES = ("scene", "system", "hamiltonian", "every")
HAMILTONIAN_KEYS = (*HAMILTONIAN_SOURCES, "parameters")
_LEAST_DIGITS = 20  # certified of every value, unless the claim asks for more or fewer
_MORE_DIGITS = 5  # than are printed

ON_RUNS = (
    ValueClaim, TableClaim, SpreadClaim, MonotoneClaim, LessClaim, MagnitudeClaim, BoundedClaim,
    GrowthClaim, CriteriaClaim,
)  # fmt: skip
ONE_RUN = (ValueClaim, GrowthClaim)  # the others may have many


class ClaimedHamiltonian(Frozen):
    """Of which H; `parameters` are of `system` or `hamiltonian`."""

    system: str | None = None
    hamiltonian: str | None = None
    parameters: dict[str, Number] = Field(default_factory=dict)


class RunKeys(Frozen):
    """Of which runs; None where the claim does not say."""

    step_size: StepSize | None = None
    step_sizes: tuple[StepSize, ...] | None = None
    time: Time | None = None
    steps: Steps | None = None
    q: Number | None = None
    p: Number | None = None
    initial_values: tuple[InitialValue, ...] | None = None
    digits: Digits | None = None


RUN_KEYS = tuple(RunKeys.model_fields)


def scene_for(
    claim: Claim,
    hamiltonian_keys: Mapping[str, Any],
    runs: Mapping[str, Any],
    named: Callable[[str], Scene],
) -> tuple[str, Scene]:
    """The scene that the claim speaks of and a name for it that no other claim's scene has.

    `hamiltonian_keys` and `runs`: the claim's keys of H and of its runs; `named` finds a scene by
    its name. Raises InputError, whose name is the key, and pydantic's ValidationError.
    """
    if len([name for name in HAMILTONIAN_SOURCES if name in hamiltonian_keys]) != 1:
        given = " and ".join(name for name in HAMILTONIAN_SOURCES if name in hamiltonian_keys)
        raise InputError(given or "scene", "", f"give one of {', '.join(HAMILTONIAN_SOURCES)}")
    if "scene" not in hamiltonian_keys:
        if isinstance(claim, FlowClaim):
            raise InputError("scene", "", "is missing: a [[flow]] of a scene is spoken of")
        own = ClaimedHamiltonian.model_validate(hamiltonian_keys)
        scene = Scene(**own.model_dump(), schemes=(claim.scheme,), name=slug(claim.id))
        return _with_grid(claim, own.system or "own", scene, None, runs)
    if "parameters" in hamiltonian_keys:
        raise InputError("parameters", "", "stand in the scene's own file")
    name = hamiltonian_keys["scene"]
    found = named(name)
    if isinstance(claim, FlowClaim):
        _check_flows(claim, name, found)
        return name, found
    if claim.scheme not in found.schemes and not (isinstance(claim, ON_RUNS) and runs):
        known = ", ".join(found.schemes)
        raise InputError("scheme", claim.scheme, f"is not in scene {name}: {known}")
    asked = set(runs) - _selecting_keys(claim)
    if isinstance(claim, ON_RUNS) and (asked or isinstance(claim, _ALWAYS_OWN)):
        bare = found.model_copy(
            update={"schemes": (claim.scheme,), "grid": None, "separation": (), "series": ()}
        )
        return _with_grid(claim, name, bare, found.grid, runs)
    if isinstance(claim, ON_RUNS) and found.grid is None and not isinstance(claim, CriteriaClaim):
        raise InputError("scene", name, "has no [grid]; say which runs: step_size, steps, q, p")
    return name, found


_ALWAYS_OWN = (ValueClaim, BoundedClaim, GrowthClaim)  # certified runs, whatever the scene has


def _check_flows(claim: FlowClaim, name: str, scene: Scene) -> None:
    """Whether the scene carries a region so, and by that map."""
    known = {flow.source: flow for flow in scene.flow if flow.source}
    for source in claim.flows:
        if source not in known:
            allowed = ", ".join(known) or "none; give a [[flow]] its source"
            problem = f"scene {name} has no such [[flow]]; it has {allowed}"
            raise InputError("flows", source, problem)
        maps = maps_of(scene, known[source])
        if claim.scheme not in maps:
            raise InputError("scheme", claim.scheme, f"is not in {source}: {', '.join(maps)}")


def _selecting_keys(claim: Claim) -> set[str]:
    """What names runs of a scene's grid among all of them, and asks for no others."""
    return set(RUN_KEYS) & set(type(claim).model_fields)


def _with_grid(
    claim: Claim, label: str, scene: Scene, base: Grid | None, runs: Mapping[str, Any]
) -> tuple[str, Scene]:
    name = f"{label}: claim {claim.id}"
    if not isinstance(claim, ON_RUNS) or (isinstance(claim, CriteriaClaim) and not runs):
        return name, scene
    keys = RunKeys.model_validate(runs)
    grid = Grid(
        **_length(keys, base),
        step_sizes=_step_sizes(keys, base),
        initial_values=_initial_values(keys, base),
        arithmetic=AUTO,
        digits=keys.digits or _digits(claim),
        observables=_observables(claim),
    )
    made = {**scene.model_dump(), "grid": grid}
    return name, Scene.model_validate(made)


def _length(keys: RunKeys, base: Grid | None) -> dict[str, Any]:
    if keys.time is not None and keys.steps is not None:
        raise InputError("steps", keys.steps, "give one of time and steps")
    if keys.time is None and keys.steps is None:
        if base is None:
            raise InputError("time", "", "is missing: give time or steps")
        return {"time": base.time, "steps": base.steps}
    return {"time": keys.time, "steps": keys.steps}


def _step_sizes(keys: RunKeys, base: Grid | None) -> tuple[Any, ...]:
    if keys.step_size is not None and keys.step_sizes is not None:
        raise InputError("step_size", keys.step_size, "give one of step_size and step_sizes")
    if keys.step_size is not None:
        return (keys.step_size,)
    if keys.step_sizes is None and base is None:
        raise InputError("step_size", "", "is missing")
    return keys.step_sizes or (base.step_sizes if base else ())


def _initial_values(keys: RunKeys, base: Grid | None) -> tuple[InitialValue, ...]:
    if keys.q is None and keys.p is None:
        if keys.initial_values is None and base is None:
            raise InputError("q", "", "is missing: give q and p, or initial_values")
        return keys.initial_values or (base.initial_values if base else ())
    if keys.initial_values is not None:
        raise InputError("initial_values", "", "give these, or q and p")
    if keys.q is None or keys.p is None:
        raise InputError("p" if keys.p is None else "q", "", "is missing: give q and p")
    return (InitialValue(q=keys.q, p=keys.p),)


def _digits(claim: Claim) -> int:
    texts: list[str] = []
    if isinstance(claim, ValueClaim):
        texts = [claim.printed or claim.lg_printed or ""]
    if isinstance(claim, TableClaim):
        texts = [cell for row in claim.rows or (claim.printed or (),) for cell in row]
    longest = max((len(cell.partition("e")[0]) for cell in texts), default=0)
    return max(_LEAST_DIGITS, longest + _MORE_DIGITS)


def _observables(claim: Claim) -> tuple[str, ...]:
    """Those that the claim asks for, and no other."""
    if isinstance(claim, BoundedClaim | GrowthClaim):
        return ("lambda_max",)
    if isinstance(claim, CriteriaClaim):
        return CLOSED_FORM
    if isinstance(claim, ValueClaim):
        return (claim.kind,)
    if isinstance(claim, MagnitudeClaim):
        names: list[str] = [*claim.exponents]
    else:
        names = [n for n in (getattr(claim, "quantity", ""), getattr(claim, "than", "")) if n]
    return tuple(dict.fromkeys(o for name in names for o in NEEDS[name]))


def slug(name: str) -> str:
    """The name with what a scene's name, or a file's, cannot have made a dash."""
    return "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in name)[:80]
