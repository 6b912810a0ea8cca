"""The properties of `verify.properties` on random scenes, until one of them is violated.

    python -m tests.mutants.battery MODULE INDEX --examples 60

plants a mutant and prints one line of JSON: `killed_by` (a property, or null), `how` ("violated",
"raised" or "refused"), `why`, `violated` (all properties that the scene violates), `scenes`,
`seconds`. INDEX −1 plants nothing: then `killed_by` must be null.
"""

import argparse
import json
import time
from collections.abc import Iterable, Sequence
from typing import Any

from tests.mutants.mutate import ROOT
from tests.mutants.planted import planted

EXAMPLES, SEED = 60, 7


def there() -> bool:
    """Whether the properties are there to be run; imports nothing of `verify`."""
    return all((ROOT / "verify" / n).exists() for n in ("properties", "explore.py"))


# == PLUG IN ==================================================================================
# The one place that knows how `verify.properties` and `verify.explore` are called.


def catalogue() -> dict[str, Any]:
    """Each property by its name; it has `.name`, `.sentence` and `.check(scene)`."""
    from verify import properties  # type: ignore[attr-defined]

    return {name: properties.get(name) for name in properties.names()}


def drawn_scenes(examples: int, seed: int) -> Iterable[Any]:
    """That many scenes, the same for the same seed."""
    from verify import explore  # type: ignore[attr-defined]

    made: Iterable[Any] = explore.scenes(examples, seed)
    return made


def violation() -> type[Exception]:
    """What a property's check raises."""
    from verify.properties import Violation  # type: ignore[import-not-found]

    found: type[Exception] = Violation
    return found


def refusal() -> tuple[type[Exception], ...]:
    """What a check raises on a scene that it has nothing to say of."""
    from verify.errors import InputError

    return (InputError,)


# == END OF PLUG IN ===========================================================================


def battery(
    examples: int = EXAMPLES, seed: int = SEED, only: Sequence[str] = ()
) -> dict[str, Any]:
    """The first scene that violates a property, with all the properties that it violates.

    An unexpected exception kills as a violation does, and so does it that no property has
    anything to say of any scene. `only`: of these properties alone.
    """
    started = time.monotonic()
    properties = {n: p for n, p in catalogue().items() if not only or n in only}
    said = scenes = 0
    for scene in drawn_scenes(examples, seed):
        scenes += 1
        wrong: list[tuple[str, str, str]] = []
        for name, one in properties.items():
            try:
                one.check(scene)
                said += 1
            except refusal():
                continue
            except violation() as error:
                wrong.append((name, "violated", str(error)))
            except Exception as error:
                wrong.append((name, "raised", f"{type(error).__name__}: {error}"))
        if wrong:
            return _found(wrong, scenes, started)
    if not said:
        return _found([("every scene", "refused", "no property says anything")], scenes, started)
    return _found([], scenes, started)


def _found(wrong: list[tuple[str, str, str]], scenes: int, started: float) -> dict[str, Any]:
    wrong = sorted(wrong, key=lambda w: w[1] != "violated")  # a violation says more than a crash
    name, how, why = wrong[0] if wrong else (None, None, "")
    return {
        "killed_by": name,
        "how": how,
        "why": why.partition("\n")[0][:300],
        "violated": [n for n, h, _ in wrong if h == "violated"],
        "scenes": scenes,
        "seconds": round(time.monotonic() - started, 2),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("module")
    parser.add_argument("index", type=int)
    parser.add_argument("--examples", type=int, default=EXAMPLES)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--only", action="append", default=[], metavar="PROPERTY")
    asked = parser.parse_args()
    if asked.index >= 0:
        planted(asked.module, asked.index)
    try:
        found = battery(asked.examples, asked.seed, asked.only)
    except Exception as error:  # the module's import fails, or no scene can be drawn
        why = f"{type(error).__name__}: {error}"
        found = {"killed_by": "import", "how": "raised", "why": why, "violated": []}
    print(json.dumps(found, ensure_ascii=False))


if __name__ == "__main__":
    main()
