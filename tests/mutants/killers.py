"""What can kill a mutant, the cheap before the dear: the battery, then files of tests.

A killer is work that is done in a child process, after the mutant is planted and before `verify`
is imported. It gives `by`, what killed the mutant (None where it lives), `how` and `why`.
"""

import ast
import cProfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from types import CodeType
from typing import Any

from tests.mutants import battery
from tests.mutants.forked import register
from tests.mutants.mutate import ROOT, path_of
from tests.mutants.planted import planted

BATTERY = "battery"
Work = Callable[[dict[str, Any]], dict[str, Any]]  # of what is known from the sound code


@dataclass(frozen=True)
class Killer:
    """`stage` 1: the properties in process, 2: a file of tests/property, 3: one of tests/unit."""

    name: str
    stage: int
    work: Work


def killers(examples: int) -> tuple[Killer, ...]:
    """Those of stages 1 and 2."""
    first = (Killer(BATTERY, 1, partial(_battery, examples)),) if battery.there() else ()
    return (*first, *(of_file(path, 2) for path in _files("property")))


def of_file(path: Path, stage: int) -> Killer:
    return Killer(path.relative_to(ROOT).as_posix(), stage, partial(_tests, path))


def unit_killers(module: str) -> tuple[Killer, ...]:
    """The files of unit tests that import the module themselves."""
    return tuple(of_file(p, 3) for p in _files("unit") if concerns(p, module))


def _files(folder: str) -> list[Path]:
    return sorted((ROOT / "tests" / folder).rglob("test_*.py"))


@cache
def concerns(path: Path, module: str) -> bool:
    """Whether the file imports the module itself."""
    above, _, last = module.rpartition(".")
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case ast.ImportFrom(module=name, names=names):
                if name == module or (name == above and last in {a.name for a in names}):
                    return True
            case ast.Import(names):
                if module in {a.name for a in names}:
                    return True
    return False


def _battery(examples: int, sound: dict[str, Any]) -> dict[str, Any]:
    found = battery.battery(examples, plan=sound.get("plan"), module=sound.get("mutated", ""))
    plan = {} if "plan" in sound else {"plan": found["plan"]}
    return {"by": found["killed_by"], "how": found["how"], "why": found["why"], **plan}


def by_property(
    name: str, examples: int, module: str, index: int, sound: dict[str, Any]
) -> dict[str, Any]:
    """One property of the battery on a mutant; to be called in a child."""
    planted(module, index)
    found = battery.battery(examples, plan=sound["plan"], only=[name], module=module)
    return {"by": found["killed_by"], "how": found["how"], "why": found["why"]}


def _tests(path: Path, sound: dict[str, Any]) -> dict[str, Any]:
    import pytest

    register()
    _settle_hypothesis()
    first = _First()
    plain = ["-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-o", "addopts="]
    status = int(pytest.main([*plain, "--tb=short", str(path)], plugins=[first]))
    if status == pytest.ExitCode.USAGE_ERROR or (status == 5 and not first.by):
        raise RuntimeError(f"pytest did not run {path.name}")  # the sound code shows it, too
    if status == 0:
        return {"by": None}
    return {"by": first.by or path.name, "how": "failed", "why": first.why}


class _First:
    """A pytest plugin: the first failure."""

    by = why = ""

    def pytest_runtest_logreport(self, report: Any) -> None:
        self._take(report)

    def pytest_collectreport(self, report: Any) -> None:
        self._take(report)

    def _take(self, report: Any) -> None:
        if report.failed and not self.by:
            self.by = report.nodeid.rpartition("/")[2].partition("[")[0]
            crash = getattr(report.longrepr, "reprcrash", None)
            text = crash.message if crash else str(report.longrepr)
            self.why = " ".join(text.split())[:300]


def _settle_hypothesis() -> None:
    """The same examples in each run, none kept, none made smaller, however slow the machine is."""
    from hypothesis import HealthCheck, Phase, settings

    slow = [HealthCheck.too_slow, HealthCheck.data_too_large]
    settings.register_profile(
        "mutants", derandomize=True, database=None, deadline=None, suppress_health_check=slow,
        phases=[Phase.explicit, Phase.generate],
    )  # fmt: skip
    settings.load_profile("mutants")


def on_mutant(killer: Killer, module: str, index: int, sound: dict[str, Any]) -> dict[str, Any]:
    """The killer's work on a mutant; to be called in a child."""
    planted(module, index)
    return killer.work(sound | {"mutated": module})


def on_sound_code(killer: Killer, modules: tuple[str, ...]) -> dict[str, Any]:
    """The killer's work with nothing planted, and which functions of the modules it enters.

    As first lines, by module; 0 is the module's own code. A killer says nothing of a mutant in a
    function that it never enters, and need not be run on it.
    """
    entered = cProfile.Profile(subcalls=False, builtins=False)  # in C: tracing costs far more
    entered.enable()
    try:
        found = killer.work({})
    finally:
        entered.disable()
    files = {str(path_of(name)): name for name in modules}
    lines: dict[str, set[int]] = {}
    for code in (entry.code for entry in entered.getstats()):
        name = files.get(code.co_filename) if isinstance(code, CodeType) else None
        if name:
            line = 0 if code.co_name == "<module>" else code.co_firstlineno
            lines.setdefault(name, set()).add(line)
    return found | {"entered": {name: sorted(x) for name, x in sorted(lines.items())}}
