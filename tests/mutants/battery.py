"""The properties of `verify.exploration.properties` on random scenes, until one of them is
violated.

    python -m tests.mutants.battery MODULE INDEX --examples 60

plants a mutant and prints one line of JSON: `killed_by` (a property, or null), `how` ("violated",
"raised" or "refused"), `why`, `plan` (the scenes that were looked at), `seconds` (of
the processor). INDEX −1 plants nothing: then `killed_by` must be null.
"""

import argparse
import contextlib
import json
import math
import random
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from tests.mutants.mutate import ROOT
from tests.mutants.planted import planted

Plan = dict[str, Any]  # `kept`: the scenes by number; `looks`: how many each property looks at

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
    properties = import_module("verify.exploration.properties")
    return {name: properties.get(name) for name in properties.names()}


def drawn_scenes(examples: int, seed: int) -> list[Any]:
    """That many scenes of any scheme, and some of each: the same for the same seed.

    A scheme that is not drawn hides its mutants. The order is mixed, as the dear properties look
    at the first scenes only.
    """
    drawer, spaces, schemes = (
        import_module(f"verify.{name}")
        for name in ("exploration.scenes_of_seed", "exploration.sample_space", "schemes")
    )
    space = spaces.SampleSpace
    asked = [(space(), k) for k in range(examples)]
    asked += [(space(schemes=(n,)), k) for n in schemes.names() for k in range(_OF_EACH)]
    random.Random(seed).shuffle(asked)  # noqa: S311 - no secret
    return [drawer.sample_scene(drawn, seed, k) for drawn, k in asked]


def example_of(scene: Any) -> Any:
    """The scene as properties look at it."""
    return import_module("verify.exploration.sample").Sample.from_scene(scene)


def violation() -> type[Exception]:
    """What a property raises where it does not hold."""
    found: type[Exception] = import_module("verify.exploration.property").Violation
    return found


# == END OF PLUG IN ===========================================================================


def battery(
    examples: int = EXAMPLES,
    seed: int = SEED,
    *,
    plan: Plan | None = None,
    budget: float = BUDGET,
    only: Sequence[str] = (),
    module: str = "",
) -> dict[str, Any]:
    """The first property that is violated, of the cheap before the dear.

    An unexpected exception kills as a violation does, and so does it that no property says anything
    of any scene. `plan`: what was looked at on the sound code, so that a mutant is held against the
    same; where it is None, by each property so many scenes as take `budget` seconds of the
    processor, without those whose proof alone takes longer. `only`: of these properties alone.
    `module`: where the mutant is; for a scheme's, the scenes of this scheme come first.
    """
    used = _Used(time.process_time())
    properties = {n: p for n, p in catalogue().items() if not only or n in only}
    made = [example_of(scene) for scene in drawn_scenes(examples, seed)]
    if plan is None:
        used.kept = [k for k, sample in enumerate(made) if _proved_in(sample, budget)]
        made = [made[k] for k in used.kept]
        for name, one in properties.items():  # one scene of each, to know which are dear
            if used.killed(name, one, made[:1], budget):
                return used.found()
        looks = {n: len(made) for n in sorted(properties, key=lambda n: used.seconds[n])}
        made, limit = made[1:], budget
    else:
        made, looks, limit = [made[k] for k in plan["kept"]], plan["looks"], math.inf
        own = getattr(import_module(module), "EXAMPLES", ()) if module else ()
        made.sort(key=lambda sample: sample.scheme.name not in own)
        near = sum(sample.scheme.name in own for sample in made)
        looks = {name: max(most, near) for name, most in looks.items()}
    for name, most in looks.items():
        if name in properties and used.killed(name, properties[name], made[:most], limit):
            return used.found()
    return used.found() if used.said else used.found(("every scene", "refused", "nothing is said"))


def _proved_in(sample: Any, seconds: float) -> bool:
    before = time.process_time()
    with contextlib.suppress(Exception):  # a property will say so
        _ = sample.proof
    return time.process_time() - before <= seconds


@dataclass
class _Used:
    """What properties have looked at so far, and what they have found."""

    started: float
    said: int = 0
    scenes: dict[str, int] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    looks: dict[str, int] = field(default_factory=dict)
    kept: list[int] = field(default_factory=list)
    wrong: tuple[str, str, str] | None = None

    def killed(self, name: str, one: Any, examples: list[Any], budget: float) -> bool:
        """Looks at examples until the property's budget is used up; whether one is wrong."""
        violated = violation()
        for sample in examples:
            if self.seconds.get(name, 0) > budget:
                break
            before = time.process_time()
            try:
                self.said += bool(one.holds(sample))
            except violated as error:
                self.wrong = (name, "violated", str(error))
            except Exception as error:
                self.wrong = (name, "raised", f"{type(error).__name__}: {error}")
            self.seconds[name] = self.seconds.get(name, 0) + time.process_time() - before
            self.scenes[name] = self.scenes.get(name, 0) + 1
            if self.seconds[name] <= budget or name not in self.looks:
                self.looks[name] = self.scenes[name]  # without the scene that was too dear
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
            "plan": {
                "kept": self.kept,
                "looks": {n: self.looks[n] for n in sorted(cost, key=lambda n: cost[n])},
            },
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
