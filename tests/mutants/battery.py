"""The properties of `verify.properties` on random scenes, until one of them is violated.

    python -m tests.mutants.battery MODULE INDEX --examples 60

plants a mutant and prints one line of JSON: `killed_by` (a property, or null), `how` ("violated",
"raised" or "refused"), `why`, `plan` (how many scenes each property has looked at), `seconds` (of
the processor). INDEX −1 plants nothing: then `killed_by` must be null.
"""

import argparse
import json
import math
import random
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from tests.mutants.mutate import ROOT
from tests.mutants.planted import planted

EXAMPLES, SEED = 60, 7
_OF_EACH = 3  # more scenes of each scheme
BUDGET = 1.0  # seconds for one property on the sound code: some compile kernels for each scene


def there() -> bool:
    """Whether the properties are there to be run; imports nothing of `verify`."""
    return all((ROOT / "verify" / n).exists() for n in ("properties", "drawn_scenes.py"))


# == PLUG IN ==================================================================================
# The one place that knows how properties are called and how scenes are drawn. Nothing of `verify`
# is imported before a mutant is planted.


def catalogue() -> dict[str, Any]:
    """Each property by its name; `holds(example)` is False where it says nothing of it."""
    properties = import_module("verify.properties")
    return {name: properties.get(name) for name in properties.names()}


def drawn_scenes(examples: int, seed: int) -> list[Any]:
    """That many scenes of any scheme, and some of each: the same for the same seed.

    A scheme that is not drawn hides its mutants. The order is mixed, as the dear properties look
    at the first scenes only.
    """
    drawer, tasks, schemes = (
        import_module(f"verify.{name}") for name in ("drawn_scenes", "tasks", "schemes")
    )
    asked = [(tasks.Drawn(), k) for k in range(examples)]
    asked += [(tasks.Drawn(schemes=(n,)), k) for n in schemes.names() for k in range(_OF_EACH)]
    random.Random(seed).shuffle(asked)  # noqa: S311 - no secret
    return [drawer.drawn_scene(drawn, seed, k) for drawn, k in asked]


def example_of(scene: Any) -> Any:
    """The scene as properties look at it."""
    return import_module("verify.example").Example.of(scene)


def violation() -> type[Exception]:
    """What a property raises where it does not hold."""
    found: type[Exception] = import_module("verify.property").Violation
    return found


# == END OF PLUG IN ===========================================================================


def battery(
    examples: int = EXAMPLES,
    seed: int = SEED,
    *,
    plan: Mapping[str, int] | None = None,
    budget: float = BUDGET,
    only: Sequence[str] = (),
    module: str = "",
) -> dict[str, Any]:
    """The first property that is violated, of the cheap before the dear.

    An unexpected exception kills as a violation does, and so does it that no property says anything
    of any scene. `plan`: how many scenes each property looks at, as it was found on the sound code,
    so that a mutant is held against the same; where it is None, as many as take `budget` seconds
    of the processor. `only`: of these properties alone. `module`: where the mutant is; that of a
    scheme is held against the scenes of this scheme alone, and by all properties.
    """
    used = _Used(time.process_time())
    properties = {n: p for n, p in catalogue().items() if not only or n in only}
    made = [example_of(scene) for scene in drawn_scenes(examples, seed)]
    own = getattr(import_module(module), "EXAMPLES", ()) if module else ()
    near = [example for example in made if example.scheme.name in own]
    if near and plan is not None:
        made, plan = near, dict.fromkeys(plan, len(near))
    first = made[:1] if plan is None else []
    for name, one in properties.items():  # one scene of each, to know which are dear
        if used.killed(name, one, first, budget):
            return used.found()
    for name in plan or sorted(properties, key=lambda n: used.seconds[n]):
        if name in properties:
            rest = made[len(first) :] if plan is None else made[: plan[name]]
            if used.killed(name, properties[name], rest, budget if plan is None else math.inf):
                return used.found()
    return used.found() if used.said else used.found(("every scene", "refused", "nothing is said"))


@dataclass
class _Used:
    """What properties have looked at so far, and what they have found."""

    started: float
    said: int = 0
    scenes: dict[str, int] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    plan: dict[str, int] = field(default_factory=dict)
    wrong: tuple[str, str, str] | None = None

    def killed(self, name: str, one: Any, examples: list[Any], budget: float) -> bool:
        """Looks at examples until the property's budget is used up; whether one is wrong."""
        violated = violation()
        for example in examples:
            if self.seconds.get(name, 0) > budget:
                break
            before = time.process_time()
            try:
                self.said += bool(one.holds(example))
            except violated as error:
                self.wrong = (name, "violated", str(error))
            except Exception as error:
                self.wrong = (name, "raised", f"{type(error).__name__}: {error}")
            self.seconds[name] = self.seconds.get(name, 0) + time.process_time() - before
            self.scenes[name] = self.scenes.get(name, 0) + 1
            if self.seconds[name] <= budget or name not in self.plan:
                self.plan[name] = self.scenes[name]  # without the scene that was too dear
            if self.wrong:
                return True
        return False

    def found(self, wrong: tuple[str, str, str] | None = None) -> dict[str, Any]:
        name, how, why = wrong or self.wrong or (None, None, "")
        cost = {n: s / self.scenes[n] for n, s in self.seconds.items()}
        return {
            "killed_by": name,
            "how": how,
            "why": why.partition("\n")[0][:300],
            "plan": {n: self.plan[n] for n in sorted(cost, key=lambda n: cost[n])},
            "seconds": round(time.process_time() - self.started, 2),
        }


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("module")
    parser.add_argument("index", type=int)
    parser.add_argument("--examples", type=int, default=EXAMPLES)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--budget", type=float, default=BUDGET)
    parser.add_argument("--only", action="append", default=[], metavar="PROPERTY")
    asked = parser.parse_args()
    if asked.index >= 0:
        planted(asked.module, asked.index)
    try:
        found = battery(asked.examples, asked.seed, budget=asked.budget, only=asked.only)
    except Exception as error:  # the module's import fails, or no scene can be drawn
        why = f"{type(error).__name__}: {error}"
        found = {"killed_by": "import", "how": "raised", "why": why[:300]}
    print(json.dumps(found, ensure_ascii=False))


if __name__ == "__main__":
    main()
