"""Maps that are no functions of their arguments alone, though one call does not show it."""

# ruff: noqa: PTH123, S311

import functools
import itertools
import logging
import math
import os
import random
import sys
import threading
import time
from collections import deque
from enum import Enum
from random import random as draw
from time import perf_counter
from typing import Any

import numpy as np

COUNT = [0]
TABLE: dict[str, int] = {"calls": 0}
SEEN: set[int] = set()
NUMBERS = itertools.count()
STATE = threading.local()
BEGUN = time.time()
CALLS = 0
ARRAY = np.zeros(2)
RANDOM = np.random.default_rng(1)
LOG = logging.getLogger("maps")


def in_a_list(p: Any, q: Any) -> Any:
    COUNT[0] += 1
    return (1.001 * p if COUNT[0] % 20 == 0 else p), q


def in_a_list_by_its_type(p: Any, q: Any) -> Any:
    list.append(COUNT, 1)
    return p * len(COUNT), q


def in_a_dict(p: Any, q: Any) -> Any:
    TABLE["calls"] += 1
    return p, q


def in_a_set(p: Any, q: Any) -> Any:
    SEEN.add(len(SEEN))
    return p, q


def in_an_array(p: Any, q: Any) -> Any:
    ARRAY[0] += 1
    return p, q


def in_a_global(p: Any, q: Any) -> Any:
    global CALLS
    CALLS += 1
    return p, q


def in_globals(p: Any, q: Any) -> Any:
    globals()["CALLS"] = CALLS + 1
    return p, q


def in_a_local_of_the_thread(p: Any, q: Any) -> Any:
    STATE.n = getattr(STATE, "n", 0) + 1
    return p, q


def in_math(p: Any, q: Any) -> Any:
    math.counter = getattr(math, "counter", 0) + 1  # type: ignore[attr-defined]
    return p, q


def in_math_imported_here(p: Any, q: Any) -> Any:
    import math as m

    m.counter = getattr(m, "counter", 0) + 1  # type: ignore[attr-defined]
    return p, q


def in_sys(p: Any, q: Any) -> Any:
    sys.x = getattr(sys, "x", 0) + 1  # type: ignore[attr-defined]
    return p, q


def by_the_clock(p: Any, q: Any) -> Any:
    return (1.001 * p if time.time() - BEGUN > 3600 else p), q


def by_another_clock(p: Any, q: Any) -> Any:
    return (1.001 * p if perf_counter() < 0 else p), q


def by_a_clock_imported_here(p: Any, q: Any) -> Any:
    from time import monotonic

    return (1.001 * p if monotonic() < 0 else p), q


def by_chance(p: Any, q: Any) -> Any:
    return (1.001 * p if random.random() < 1e-9 else p), q


def by_chance_by_name(p: Any, q: Any) -> Any:
    return (1.001 * p if draw() < 1e-9 else p), q


def by_numpys_chance(p: Any, q: Any) -> Any:
    return (1.001 * p if np.random.rand() < 1e-9 else p), q


def by_a_generator(p: Any, q: Any) -> Any:
    return (1.001 * p if RANDOM.random() < 1e-9 else p), q


def by_the_next_number(p: Any, q: Any) -> Any:
    return p + 0 * next(NUMBERS), q


def in_a_default(p: Any, q: Any, calls: Any = [0]) -> Any:  # noqa: B006
    calls[0] += 1
    return p, q


def in_an_attribute(p: Any, q: Any) -> Any:
    in_an_attribute.calls = getattr(in_an_attribute, "calls", 0) + 1  # type: ignore[attr-defined]
    return p, q


def by_the_environment(p: Any, q: Any) -> Any:
    return (1.001 * p if "NEVER_SET" in os.environ else p), q


def by_a_file(p: Any, q: Any) -> Any:
    with open(__file__) as file:
        return p * len(file.readline()), q


def by_its_address(p: Any, q: Any) -> Any:
    return (1.001 * p if id(COUNT) == 5 else p), q


def by_a_log(p: Any, q: Any) -> Any:
    LOG.debug("called")
    return p, q


def in_a_class_defined_here(p: Any, q: Any) -> Any:
    class Inner:
        begun = time.time()

    return p + 0 * Inner.begun, q


@functools.lru_cache
def cached_by_chance(p: Any, q: Any) -> Any:
    return p + random.random(), q


def _cell() -> Any:
    n = 0

    def in_a_cell(p: Any, q: Any) -> Any:
        nonlocal n
        n += 1
        return p, q

    return in_a_cell


in_a_cell = _cell()


class Counter:
    made = 0
    table: list[int] = []  # noqa: RUF012
    __calls__: list[int] = []  # noqa: RUF012

    def __init__(self) -> None:
        self.n = 0
        self.random = random.Random(1)

    def in_itself(self, p: Any, q: Any) -> Any:
        self.n += 1
        return p, q

    def in_its_class(self, p: Any, q: Any) -> Any:
        Counter.made += 1
        return p, q

    def in_its_class_by_itself(self, p: Any, q: Any) -> Any:
        self.__class__.made += 1
        return p, q

    def in_its_type(self, p: Any, q: Any) -> Any:
        type(self).made += 1
        return p, q

    def in_a_list_of_its_class(self, p: Any, q: Any) -> Any:
        self.table.append(1)
        return p, q

    def in_a_special_list(self, p: Any, q: Any) -> Any:
        self.__calls__.append(1)
        return p, q

    @classmethod
    def by_a_method_of_its_class(cls, p: Any, q: Any) -> Any:
        cls.made += 1
        return p, q

    @property
    def number(self) -> int:
        self.n += 1
        return 1

    def by_a_property(self, p: Any, q: Any) -> Any:
        return p * self.number, q

    def by_its_generator(self, p: Any, q: Any) -> Any:
        return p * self.random.random(), q

    def __call__(self, p: Any, q: Any) -> Any:
        return self.in_itself(p, q)


class Queue:
    queue: deque[int] = deque()  # noqa: RUF012

    def in_a_queue(self, p: Any, q: Any) -> Any:
        self.queue.append(1)
        return p, q


class Drawing:
    drawn = staticmethod(random.Random.randint)

    def by_a_function_of_pythons(self, p: Any, q: Any) -> Any:
        return p + self.drawn(random, 1, 2), q


class Vector:
    made = 0

    def __init__(self, x: Any, y: Any) -> None:
        Vector.made += 1
        self.x, self.y = x, y


COUNTER = Counter()


class Form(Enum):
    KICK = 1


def in_an_enum(p: Any, q: Any) -> Any:
    Form.KICK.calls = getattr(Form.KICK, "calls", 0) + 1  # type: ignore[attr-defined]
    return p, q


def by_an_object(p: Any, q: Any) -> Any:
    return COUNTER.in_itself(p, q)


def by_making_objects(p: Any, q: Any) -> Any:
    v = Vector(p, q)
    return v.x, v.y


BY_NAME: dict[str, tuple[Any, str]] = {
    "in_a_list": (in_a_list, "COUNT is changed"),
    "in_a_list_by_its_type": (in_a_list_by_its_type, "COUNT is changed"),
    "in_a_dict": (in_a_dict, "TABLE is changed"),
    "in_a_set": (in_a_set, "SEEN is changed"),
    "in_an_array": (in_an_array, "ARRAY is changed"),
    "in_a_global": (in_a_global, "CALLS is changed"),
    "in_globals": (in_globals, "globals; CALLS is changed"),
    "in_a_local_of_the_thread": (in_a_local_of_the_thread, "STATE (thread.local)"),
    "in_math": (in_math, "math.counter is changed"),
    "in_math_imported_here": (in_math_imported_here, "math.counter is changed"),
    "in_sys": (in_sys, "sys.x is changed"),
    "by_the_clock": (by_the_clock, "time.time"),
    "by_another_clock": (by_another_clock, "time.perf_counter"),
    "by_a_clock_imported_here": (by_a_clock_imported_here, "time.monotonic"),
    "by_chance": (by_chance, "random.random"),
    "by_chance_by_name": (by_chance_by_name, "draw"),
    "by_numpys_chance": (by_numpys_chance, "numpy.random.rand"),
    "by_a_generator": (by_a_generator, "RANDOM (numpy.random.generator.Generator)"),
    "by_the_next_number": (by_the_next_number, "NUMBERS (itertools.count)"),
    "in_a_default": (in_a_default, "a default of in_a_default is changed"),
    "in_an_attribute": (in_an_attribute, "in_an_attribute.calls is changed"),
    "by_the_environment": (by_the_environment, "os.environ (os.Environ)"),
    "by_a_file": (by_a_file, "io.open"),
    "by_its_address": (by_its_address, "id"),
    "by_a_log": (by_a_log, "LOG (logging.Logger)"),
    "in_a_class_defined_here": (in_a_class_defined_here, "time.time"),
    "cached_by_chance": (cached_by_chance, "random.random"),
    "in_a_cell": (in_a_cell, "n is changed"),
    "in_itself": (Counter().in_itself, "self.n is changed"),
    "in_its_class": (Counter().in_its_class, "Counter.made is changed"),
    "in_its_class_by_itself": (Counter().in_its_class_by_itself, "Counter.made is changed"),
    "in_its_type": (Counter().in_its_type, "Counter.made is changed"),
    "in_a_list_of_its_class": (Counter().in_a_list_of_its_class, "Counter.table is changed"),
    "by_a_method_of_its_class": (Counter.by_a_method_of_its_class, "Counter.made is changed"),
    "in_a_special_list": (Counter().in_a_special_list, "Counter.__calls__ is changed"),
    "in_a_queue": (Queue().in_a_queue, "Queue.queue (collections.deque)"),
    "by_a_function_of_pythons": (
        Drawing().by_a_function_of_pythons,
        "Drawing.drawn; random.randrange",
    ),
    "by_a_property": (Counter().by_a_property, "self.n is changed"),
    "by_its_generator": (Counter().by_its_generator, "self.random (random.Random)"),
    "a_called_object": (Counter(), "Counter.n is changed"),
    "by_an_object": (by_an_object, "COUNTER.n is changed"),
    "in_an_enum": (in_an_enum, "Form.KICK.calls is changed"),
    "by_making_objects": (by_making_objects, "Vector.made is changed"),
}
