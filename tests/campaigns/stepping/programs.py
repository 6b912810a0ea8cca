"""A step as a Python file: its constants, force, velocity and lines, in plain floats."""

import random
from collections.abc import Sequence
from dataclasses import dataclass

from tests.campaigns.stepping.methods import CLOCK, METHODS, MISTAKES, Method, Parts
from tests.campaigns.stepping.systems import SYSTEMS, InUnits, in_units
from tests.campaigns.stepping.truth import Truth, truth_of

_OF_NUMBERS = """
def plus(x, c, y):
    return x + c*y


def minus(x, y):
    return x - y


def same(x, y):
    return x == y

"""
_OF_LISTS = """
def plus(x, c, y):
    return [a + c*b for a, b in zip(x, y)]


def minus(x, y):
    return [a - b for a, b in zip(x, y)]


def same(x, y):
    return all(a == b for a, b in zip(x, y))

"""
_DRAWS = 400


@dataclass(frozen=True)
class Case:
    """A program, the H that it is for, what is claimed of it, and what is true."""

    name: str
    units: InUnits
    method: Method
    mistake: str  # or empty
    source: str
    truth: Truth

    @property
    def claims(self) -> list[str]:
        return ["--order", str(self.method.order), *["--symplectic"] * self.method.symplectic]

    @property
    def right(self) -> bool:
        """Whether what is claimed is true."""
        symplectic = self.truth.symplectic or not self.method.symplectic
        return symplectic and self.truth.order >= self.method.order


def source_of(units: InUnits, parts: Parts) -> str:
    """The program of these parts."""
    system, several = units.system, units.system.degrees > 1
    numbers = {**parts.constants, **parts.names}
    clock = ", t" if system.timed else ""
    lines = (
        parts.lines
        if system.timed
        else [CLOCK.sub(")", x).replace(", )", ")") for x in parts.lines]
    )
    return "\n".join(
        (
            f'"""{system.name}: H = {system.kinetic} + {system.potential}."""\n',
            "from math import cos, exp, log, sin, sqrt\n",
            *(f"{name} = {text}" for name, text in numbers.items()),
            "\n",
            *_function("velocity(p)", "p", parts.velocity),
            *_function(f"force(q{clock})", "q", system.force),
            (_OF_LISTS if several else _OF_NUMBERS).lstrip(),
            "",
            f"def step(p, q{clock}, h):",
            *(f"    {line}" for line in lines),
            "    return p, q",
            "",
        )
    )


def _function(head: str, name: str, texts: Sequence[str]) -> list[str]:
    if len(texts) == 1:
        return [f"def {head}:", f"    return {texts[0]}", "\n"]
    names = ", ".join(f"{name}{k + 1}" for k in range(len(texts)))
    return [f"def {head}:", f"    {names} = {name}", f"    return [{', '.join(texts)}]", "\n"]


def right_one(name: str, draw: random.Random, decades: float = 6) -> Case:
    """A method that keeps what it claims."""
    system = SYSTEMS[draw.choice(sorted(SYSTEMS))]
    method = METHODS[draw.choice([x for x in sorted(METHODS) if _goes(METHODS[x], system.name)])]
    units = in_units(system, draw, decades)
    case = _case(name, units, method, "", _parts(units, method))
    assert case.right, (name, system.name, method.name, case.truth)
    return case


def spoilt_one(name: str, draw: random.Random, kind: str, decades: float = 6) -> Case:
    """One with a mistake of this kind, that keeps less than it claims."""
    for _ in range(_DRAWS):
        names = [x for x in sorted(SYSTEMS) if kind != "clock" or SYSTEMS[x].timed]
        system = SYSTEMS[draw.choice(names)]
        method = METHODS[
            draw.choice([x for x in sorted(METHODS) if _goes(METHODS[x], system.name)])
        ]
        units = in_units(system, draw, decades)
        parts = MISTAKES[kind](_parts(units, method), draw)
        if parts is None:
            continue
        case = _case(name, units, method, kind, parts)
        if not case.right:
            return case
    raise AssertionError(f"no mistake of the kind {kind} is drawn in {_DRAWS}")


def _parts(units: InUnits, method: Method) -> Parts:
    return Parts(method.lines, method.names, units.constants, units.system.velocity)


def _case(name: str, units: InUnits, method: Method, mistake: str, parts: Parts) -> Case:
    source = source_of(units, parts)
    return Case(name, units, method, mistake, source, truth_of(units, source))


def _goes(method: Method, system: str) -> bool:
    return not method.quadratic or system != "relativistic"
