"""Maps that are functions of their arguments alone, in the ways in which people write them."""

# ruff: noqa: S311

import functools
import logging
import math
import random
import types
from collections import namedtuple
from dataclasses import dataclass, field
from enum import Enum
from fractions import Fraction
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy import array, zeros

from tests.helpers.programs import user_steps

H = 0.1
WEIGHTS = [0.5, Fraction(1, 2)]
MATRIX = np.array([[1.0, 0.5], [0.0, 1.0]])
UNUSED = random.Random(1)
LOG = logging.getLogger("maps")
DEBUG = False
Point = namedtuple("Point", "p q")
TABLE = types.MappingProxyType({"h": 0.1})
SPACE = types.SimpleNamespace(h=0.1, weights=(0.5, 0.5))


class State(NamedTuple):
    p: Any
    q: Any

    def kicked(self, h: Any) -> "State":
        return State(self.p - h * math.sin(self.q), self.q)


@dataclass(frozen=True)
class Parameters:
    h: float = 0.1
    weights: list[float] = field(default_factory=lambda: [1.0])

    @property
    def half(self) -> float:
        return self.h / 2


PARAMETERS = Parameters()


@dataclass
class Moving:
    p: Any
    q: Any

    def kick(self, h: Any) -> None:
        self.p -= h * math.sin(self.q)

    def drift(self, h: Any) -> None:
        self.q += h * self.p


class Form(Enum):
    KICK = "kick"
    DRIFT = "drift"


def force(q: Any) -> Any:
    return -math.sin(q)


FORCES = {"pendulum": force, "spring": lambda q: -q}


def with_globals(p: Any, q: Any) -> Any:
    for w in WEIGHTS:
        p = p + w * H * FORCES["pendulum"](q)
    return p, q


def by_a_matrix(p: Any, q: Any) -> Any:
    z = MATRIX @ np.array([p, q])
    return z[0], z[1]


def in_local_arrays(p: Any, q: Any) -> Any:
    z = zeros(2)
    z[0], z[1] = p, q
    z[0] -= H * np.sin(z[1])
    z += array([0, 1]) * H * z[0]
    return z


def in_local_lists(p: Any, q: Any) -> Any:
    stages = []
    for w in (0.5, 0.5):
        stages.append(w * force(q))
    seen: dict[str, Any] = {}
    seen["sum"] = sum(k for k in stages)
    return p + H * seen["sum"], q


def with_a_local_class(p: Any, q: Any) -> Any:
    class Shear:
        h = H
        turn = pi

        def __call__(self, p: Any, q: Any) -> Any:
            return p + self.h * math.sin(q), q

    return Shear()(p, q)


def with_what_is_imported_here(p: Any, q: Any) -> Any:
    import math as m

    from numpy import cos

    return p - H * m.sin(q) * cos(q), q


def with_a_module_of_the_users(p: Any, q: Any) -> Any:
    return user_steps.verlet(p, q, user_steps.A * 0 + H)


def with_named_tuples(p: Any, q: Any) -> Any:
    one = State(p, q).kicked(H)
    two = Point(*one)._replace(p=one.p)
    return two.p, two.q + H * two.p


def with_a_dataclass(p: Any, q: Any) -> Any:
    moving = Moving(p, q)
    moving.kick(PARAMETERS.half * PARAMETERS.weights[0])
    moving.drift(Parameters(0.2).h)
    return moving.p, moving.q


def with_a_namespace(p: Any, q: Any) -> Any:
    return p + SPACE.h * SPACE.weights[0] * force(q) + TABLE["h"], q


def with_an_enum(p: Any, q: Any) -> Any:
    for form in Form:
        if form is Form.KICK:
            p = p + H * force(q)
        elif form.value == "drift":
            q = q + H * p
    return p, q


def with_what_is_not_reached(p: Any, q: Any) -> Any:
    if DEBUG:
        LOG.info("%s", UNUSED.random())
    return p + H * force(q), q


def printing(p: Any, q: Any) -> Any:
    print("a step", end="")
    return p, q + 1


def catching(p: Any, q: Any) -> Any:
    try:
        {}["missing"]
    except KeyError:
        p = p + H * force(q)
    return p, q


def as_it_was(p: Any, q: Any) -> Any:
    """What one call leaves as it was, every call does."""
    WEIGHTS.append(1)
    q = q + WEIGHTS.pop() * H * p
    return p, q


@functools.lru_cache
def cached(p: Any, q: Any) -> Any:
    return p + H * force(q), q


def _closed(h: float) -> Any:
    weights = [h / 2, h / 2]

    def inner(p: Any, q: Any) -> Any:
        total = 0
        for w in weights:

            def add(w: Any = w) -> None:
                nonlocal total
                total += w

            add()
        return p + total * force(q), q

    return inner


def _stepping(p: Any, q: Any, h: Any) -> Any:
    return p + h * force(q), q


class Base:
    __slots__ = ("h",)

    def __init__(self, h: float) -> None:
        self.h = h

    def force(self, q: Any) -> Any:
        return -self.h * q


class Pendulum(Base):
    count = 2

    def __init__(self, h: float) -> None:
        super().__init__(h)
        self.history: list[Any] = []
        self.log = LOG
        self.random = UNUSED

    @property
    def tables(self) -> Any:
        return np.array([self.h, 2 * self.h])

    @staticmethod
    def sine(q: Any) -> Any:
        return np.sin(q)

    @classmethod
    def counted(cls, q: Any) -> Any:
        return cls.count * q

    def force(self, q: Any) -> Any:
        return super().force(q) * self.sine(q) + self.counted(q) * self.tables[0]

    def step(self, p: Any, q: Any) -> Any:
        return p + self.force(q), q

    def __call__(self, p: Any, q: Any) -> Any:
        return self.step(p, q)

    def __getitem__(self, k: int) -> Any:
        return self.h


PENDULUM = Pendulum(0.1)


def with_an_object(p: Any, q: Any) -> Any:
    assert isinstance(PENDULUM, Base)
    return p + PENDULUM.force(q) + PENDULUM[0], q


def with_a_new_object(p: Any, q: Any) -> Any:
    return p + Base(H).force(q), q


MAPS = [
    with_globals,
    by_a_matrix,
    in_local_arrays,
    in_local_lists,
    with_a_local_class,
    with_what_is_imported_here,
    with_a_module_of_the_users,
    with_named_tuples,
    with_a_dataclass,
    with_a_namespace,
    with_an_enum,
    with_what_is_not_reached,
    printing,
    catching,
    as_it_was,
    cached,
    _closed(0.1),
    functools.partial(_stepping, h=0.1),
    Pendulum(0.2).step,
    Pendulum(0.2),
    with_an_object,
    with_a_new_object,
]
