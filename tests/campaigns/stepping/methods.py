"""Thirteen methods as lines of Python, with the mistakes that people make in them.

A line is of a step(p, q, h) or step(p, q, t, h); `plus(x, c, y)` is x + c·y of numbers or lists,
`minus` and `same` are as they are called.
"""

import random
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

Lines = tuple[str, ...]
CLOCK = re.compile(r"(?<=, )t \+ .*?\*h\)")  # of a force(q, t + c*h)
_COEFFICIENT = re.compile(r"(?<=, )([^,]*?)\*h(?=, )")  # of a plus(x, c*h, y)


@dataclass(frozen=True)
class Method:
    """`lines` of its step, after which p and q are the new ones; `names`: numbers before it."""

    name: str
    order: int
    symplectic: bool
    lines: Lines
    names: Mapping[str, str]
    quadratic: bool = False  # it is for T(p) that is a sum of squares


def _kick(c: str, clock: str) -> str:
    return f"p = plus(p, {c}*h, force(q, t + {clock}*h))"


def _drift(c: str) -> str:
    return f"q = plus(q, {c}*h, velocity(p))"


def _splitting(name: str, order: int, parts: str, **names: str) -> Method:
    """`parts`: k and d with their coefficients, as "k 1/2, d 1, k 1/2"."""
    lines, clock = [], ["0"]
    for part in parts.split(", "):
        kind, c = part.split(" ", 1)
        if kind == "d":
            lines.append(_drift(c))
            clock.append(c)
        else:
            lines.append(_kick(c, f"({' + '.join(clock)})"))
    return Method(name, order, True, tuple(lines), names)


_IMPLICIT = (
    "p0, q0 = p, q",
    "a, b = p, q",
    "for _ in range(200):",
    "    u, v = plus(p0, 0.5, minus(a, p0)), plus(q0, 0.5, minus(b, q0))",
    "    p, q = plus(p0, 1*h, force(v, t + 1/2*h)), plus(q0, 1*h, velocity(u))",
    "    if same(p, a) and same(q, b):",
    "        break",
    "    a, b = p, q",
)
_MIDPOINT = (
    "u, v = plus(p, 1/2*h, force(q, t + 0*h)), plus(q, 1/2*h, velocity(p))",
    "p, q = plus(p, 1*h, force(v, t + 1/2*h)), plus(q, 1*h, velocity(u))",
)
_HEUN = (
    "a, b = force(q, t + 0*h), velocity(p)",
    "c, d = force(plus(q, 1*h, b), t + 1*h), velocity(plus(p, 1*h, a))",
    "p, q = plus(p, 1/2*h, plus(a, 1, c)), plus(q, 1/2*h, plus(b, 1, d))",
)
_RK4 = (
    "a1, b1 = force(q, t + 0*h), velocity(p)",
    "a2, b2 = force(plus(q, 1/2*h, b1), t + 1/2*h), velocity(plus(p, 1/2*h, a1))",
    "a3, b3 = force(plus(q, 1/2*h, b2), t + 1/2*h), velocity(plus(p, 1/2*h, a2))",
    "a4, b4 = force(plus(q, 1*h, b3), t + 1*h), velocity(plus(p, 1*h, a3))",
    "p = plus(plus(plus(plus(p, 1/6*h, a1), 1/3*h, a2), 1/3*h, a3), 1/6*h, a4)",
    "q = plus(plus(plus(plus(q, 1/6*h, b1), 1/3*h, b2), 1/3*h, b3), 1/6*h, b4)",
)
# Velocities are linear in p, so that those of a force are its accelerations.
_NYSTROM = (
    "w, a1 = velocity(p), velocity(force(q, t + 0*h))",
    "a2 = velocity(force(plus(plus(q, 1/2*h, w), h*h/8, a1), t + 1/2*h))",
    "a3 = velocity(force(plus(plus(q, 1*h, w), h*h/2, a2), t + 1*h))",
    "f1, f2 = force(q, t + 0*h), force(plus(plus(q, 1/2*h, w), h*h/8, a1), t + 1/2*h)",
    "f3 = force(plus(plus(q, 1*h, w), h*h/2, a2), t + 1*h)",
    "q = plus(plus(q, 1*h, w), h*h/6, plus(a1, 2, a2))",
    "p = plus(plus(plus(p, 1/6*h, f1), 2/3*h, f2), 1/6*h, f3)",
)
_YOSHIDA = {"x1": "1.3512071919596576", "x0": "-1.7024143839193153"}

METHODS = {
    each.name: each
    for each in (
        Method("explicit-euler", 1, False,
               ("p, q = plus(p, 1*h, force(q, t + 0*h)), plus(q, 1*h, velocity(p))",), {}),
        _splitting("kick-drift", 1, "k 1, d 1"),
        _splitting("drift-kick", 1, "d 1, k 1"),
        _splitting("kick-drift-kick", 2, "k 1/2, d 1, k 1/2"),
        _splitting("drift-kick-drift", 2, "d 1/2, k 1, d 1/2"),
        _splitting("mclachlan", 2, "d xi, k 1/2, d (1 - 2*xi), k 1/2, d xi",
                   xi="0.1931833275037836"),
        _splitting("ruth", 3, "k 7/24, d 2/3, k 3/4, d -2/3, k -1/24, d 1"),
        _splitting("forest-ruth", 4,
                   "d x1/2, k x1, d (x1 + x0)/2, k x0, d (x1 + x0)/2, k x1, d x1/2", **_YOSHIDA),
        Method("midpoint", 2, False, _MIDPOINT, {}),
        Method("heun", 2, False, _HEUN, {}),
        Method("rk4", 4, False, _RK4, {}),
        Method("nystrom", 4, False, _NYSTROM, {}, quadratic=True),
        Method("implicit-midpoint", 2, True, _IMPLICIT, {}),
    )
}  # fmt: skip


# -- mistakes -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Parts:
    """What a program is written from."""

    lines: Lines
    names: Mapping[str, str]
    constants: Mapping[str, str]
    velocity: Sequence[str]


Mistake = Callable[[Parts, random.Random], Parts | None]


def _with(parts: Parts, lines: Sequence[str]) -> Parts:
    return Parts(tuple(lines), parts.names, parts.constants, parts.velocity)


def _changed_coefficient(
    parts: Parts, draw: random.Random, change: Callable[[str], str]
) -> Parts | None:
    places = [(k, m) for k, line in enumerate(parts.lines) for m in _COEFFICIENT.finditer(line)]
    if not places:
        return None
    k, place = draw.choice(places)
    line, lines = parts.lines[k], list(parts.lines)
    lines[k] = line[: place.start(1)] + change(place[1]) + line[place.end(1) :]
    return _with(parts, lines)


def _sign(parts: Parts, draw: random.Random) -> Parts | None:
    return _changed_coefficient(parts, draw, lambda c: f"-({c})")


def _factor(parts: Parts, draw: random.Random) -> Parts | None:
    by = draw.choice(["2", "0.5", "0.9", "1.1"])
    return _changed_coefficient(parts, draw, lambda c: f"{by}*({c})")


def _stage(parts: Parts, draw: random.Random) -> Parts | None:
    return _changed_coefficient(parts, draw, lambda _: "0")


def _clock(parts: Parts, draw: random.Random) -> Parts | None:
    """A stage at the beginning of the step, or at its end."""
    places = [(k, m) for k, x in enumerate(parts.lines) for m in CLOCK.finditer(x)]
    if not places:
        return None
    k, place = draw.choice(places)
    line, lines = parts.lines[k], list(parts.lines)
    lines[k] = line[: place.start()] + draw.choice(["t)", "t + h)"]) + line[place.end() :]
    return _with(parts, lines)


def _stale(parts: Parts, draw: random.Random) -> Parts | None:
    """A force that was computed before q moved."""
    places = [(k, m) for k, x in enumerate(parts.lines) for m in re.finditer(r"force\(", x)]
    if not places:
        return None
    k, place = draw.choice(places)
    line, lines = parts.lines[k], list(parts.lines)
    depth, end = 1, place.end()
    while depth:
        depth += {"(": 1, ")": -1}.get(line[end], 0)
        end += 1
    lines[k] = line[: place.start()] + "old" + line[end:]
    return _with(parts, ["old = force(q, t + 0*h)", *lines])


def _mass(parts: Parts, draw: random.Random) -> Parts | None:
    """One body's momentum in place of its velocity."""
    k = draw.randrange(len(parts.velocity))
    velocity = list(parts.velocity)
    velocity[k] = re.sub(r"/\(m\*l\*\*2\)|/[mM]\b", "", velocity[k])
    if velocity[k] == parts.velocity[k]:
        return None
    return Parts(parts.lines, parts.names, parts.constants, velocity)


def _digit(parts: Parts, draw: random.Random) -> Parts | None:
    """Another digit, one of the first five, in a constant of H or a coefficient."""
    constants, names = dict(parts.constants), dict(parts.names)
    where = draw.choice([constants, names] if names else [constants])
    name = draw.choice(sorted(where))
    text = where[name]
    head = re.match(r"-?0*\.?0*", text)
    begin = head.end() if head else 0
    digits = [k for k, x in enumerate(text) if x.isdigit() and begin <= k < begin + 6]
    digits = [k for k in digits if "e" not in text[:k]]
    k = draw.choice(digits)
    other = draw.choice([x for x in "123456789" if x != text[k]])
    where[name] = text[:k] + other + text[k + 1 :]
    return Parts(parts.lines, names, constants, parts.velocity)


MISTAKES: Mapping[str, Mistake] = {
    "sign": _sign, "factor": _factor, "stage": _stage, "clock": _clock, "stale force": _stale,
    "mass": _mass, "digit": _digit,
}  # fmt: skip
