"""Twenty Hamiltonians with explicit constants, each with its velocity and force as people write
them, in units of length, time and mass that are drawn."""

import random
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

# Exponents of length, time and mass of a constant, and its value in units of the motion.
Dimensions = tuple[float, float, float, float]
_MOMENTUM, _ANGULAR = (1, -1, 1), (2, -1, 1)
_MASS, _SPRING, _ENERGY = (0, 0, 1, 1.0), (0, -2, 1, 1.0), (2, -2, 1, 1.0)
_LENGTH = (1, 0, 0, 1.0)


@dataclass(frozen=True)
class System:
    """H = T(p) + V(q, t) by the names of its constants. `velocity` and `force`: one text a
    coordinate. `places`: points (p…, q…) in units of the motion, far from what is singular.
    `angles`: q has no unit. `mass`: what stands for a mass in the velocity, if any."""

    name: str
    constants: Mapping[str, Dimensions]
    kinetic: str
    potential: str
    velocity: Sequence[str]
    force: Sequence[str]
    places: Sequence[Sequence[float]]
    angles: bool = False
    timed: bool = False

    @property
    def degrees(self) -> int:
        return len(self.force)

    def coordinate(self, name: str) -> str:
        """q is q where there is one, and q1 … else."""
        return name if self.degrees == 1 else f"{name}1"


@dataclass(frozen=True)
class InUnits:
    """A system with its constants as numbers, and the sizes of p, q and t in which it moves."""

    system: System
    constants: Mapping[str, str]
    p: float
    q: float
    t: float

    @property
    def hamiltonian(self) -> str:
        """As the command line is given it."""
        return with_numbers(f"{self.system.kinetic} + {self.system.potential}", self.constants)


def with_numbers(formula: str, constants: Mapping[str, str]) -> str:
    return re.sub(r"[A-Za-z]\w*", lambda name: constants.get(name[0], name[0]), formula)


def in_units(system: System, draw: random.Random, decades: float = 6) -> InUnits:
    """Length, time and mass from 10^-decades to 10^decades."""
    length, time, mass = (10 ** draw.uniform(-decades, decades) for _ in range(3))
    constants = {
        name: f"{value * draw.uniform(0.7, 1.4) * length**a * time**b * mass**c:.6g}"
        for name, (a, b, c, value) in system.constants.items()
    }
    a, b, c = _ANGULAR if system.angles else _MOMENTUM
    return InUnits(
        system, constants, length**a * time**b * mass**c, 1 if system.angles else length, time
    )


def _one(name: str, constants: Mapping[str, Dimensions], potential: str, force: str,
         *places: tuple[float, float]) -> System:  # fmt: skip
    """A body on a line."""
    return System(
        name, {"m": _MASS, **constants}, "p**2/(2*m)", potential, ["p/m"], [force], places
    )


def _two(name: str, constants: Mapping[str, Dimensions], potential: str, force: Sequence[str],
         *places: Sequence[float]) -> System:  # fmt: skip
    """A body in the plane."""
    kinetic = "(p1**2 + p2**2)/(2*m)"
    velocity = ["p1/m", "p2/m"]
    return System(name, {"m": _MASS, **constants}, kinetic, potential, velocity, force, places)


_PENDULUM: dict[str, Dimensions] = {"m": _MASS, "l": _LENGTH, "g": (1, -2, 0, 1.0)}
_R = "sqrt(q1**2 + q2**2)"
_S = "sqrt(q1**2 + q2**2 + e**2)"
_D = "sqrt((q1 - q3)**2 + (q2 - q4)**2)"
_ORBITS = (0.1, 1.1, 0.9, -0.2), (-0.7, 0.6, 0.5, 0.9)
_WELLS = (0.4, 0.3, 0.2, -0.5), (-0.3, 0.5, -0.4, 0.3)

SYSTEMS = {
    each.name: each
    for each in (
        System("pendulum", _PENDULUM, "p**2/(2*m*l**2)", "-m*g*l*cos(q)", ["p/(m*l**2)"],
               ["-m*g*l*sin(q)"], [(0.4, 0.7), (-0.8, 1.9)], angles=True),
        System("driven-pendulum", {**_PENDULUM, "A": (0, 0, 0, 0.5), "w": (0, -1, 0, 2.0)},
               "p**2/(2*m*l**2)", "-m*g*l*(1 + A*cos(w*t))*cos(q)", ["p/(m*l**2)"],
               ["-m*g*l*(1 + A*cos(w*t))*sin(q)"], [(0.4, 0.7), (-0.8, 1.9)], angles=True,
               timed=True),
        System("coupled-pendula", {**_PENDULUM, "k": (2, -2, 1, 0.5)},
               "(p1**2 + p2**2)/(2*m*l**2)",
               "-m*g*l*(cos(q1) + cos(q2)) + k*(q1 - q2)**2/2", ["p1/(m*l**2)", "p2/(m*l**2)"],
               ["-m*g*l*sin(q1) - k*(q1 - q2)", "-m*g*l*sin(q2) + k*(q1 - q2)"], _WELLS,
               angles=True),
        _one("harmonic", {"k": _SPRING}, "k*q**2/2", "-k*q", (0.3, 0.8), (-0.7, 0.4)),
        _one("duffing", {"k": _SPRING, "b": (-2, -2, 1, 1.0)}, "k*q**2/2 + b*q**4/4",
             "-k*q - b*q**3", (0.3, 0.8), (-0.7, 1.1)),
        _one("double-well", {"k": _SPRING, "b": (-2, -2, 1, 1.0)}, "-k*q**2/2 + b*q**4/4",
             "k*q - b*q**3", (0.3, 0.8), (-0.7, 1.3)),
        _one("cubic", {"k": _SPRING, "b": (-1, -2, 1, 0.5)}, "k*q**2/2 + b*q**3/3",
             "-k*q - b*q**2", (0.3, 0.5), (-0.4, -0.6)),
        _one("morse", {"D": _ENERGY, "a": (-1, 0, 0, 1.0), "r": (1, 0, 0, 1.5)},
             "D*(1 - exp(-a*(q - r)))**2", "-2*D*a*exp(-a*(q - r))*(1 - exp(-a*(q - r)))",
             (0.3, 1.7), (-0.5, 1.2)),
        _one("lennard-jones", {"e": _ENERGY, "s": _LENGTH}, "4*e*((s/q)**12 - (s/q)**6)",
             "24*e*(2*(s/q)**12 - (s/q)**6)/q", (0.1, 1.5), (-0.2, 1.7)),
        _one("coulomb-trap", {"k": _SPRING, "C": (3, -2, 1, 1.0)}, "k*q**2/2 + C/q",
             "-k*q + C/q**2", (0.2, 1.1), (-0.4, 1.6)),
        System("relativistic", {"m": _MASS, "c": (1, -1, 0, 1.0), "k": _SPRING},
               "c*sqrt(m**2*c**2 + p**2)", "k*q**2/2", ["c*p/sqrt(m**2*c**2 + p**2)"], ["-k*q"],
               [(0.5, 0.8), (-0.9, 0.4)]),
        _two("henon-heiles", {"k": _SPRING, "b": (-1, -2, 1, 1.0)},
             "k*(q1**2 + q2**2)/2 + b*(q1**2*q2 - q2**3/3)",
             ["-k*q1 - 2*b*q1*q2", "-k*q2 - b*(q1**2 - q2**2)"], *_WELLS),
        _two("anharmonic", {"k": _SPRING, "K": (0, -2, 1, 2.0), "b": (-2, -2, 1, 1.0)},
             "k*q1**2/2 + K*q2**2/2 + b*q1**2*q2**2",
             ["-k*q1 - 2*b*q1*q2**2", "-K*q2 - 2*b*q1**2*q2"], *_WELLS),
        _two("kepler", {"M": (3, -2, 0, 1.0)}, f"-m*M/{_R}",
             [f"-m*M*q1/{_R}**3", f"-m*M*q2/{_R}**3"], *_ORBITS),
        _two("softened", {"M": (3, -2, 0, 1.0), "e": (1, 0, 0, 0.5)}, f"-m*M/{_S}",
             [f"-m*M*q1/{_S}**3", f"-m*M*q2/{_S}**3"], *_ORBITS),
        _two("logarithmic", {"v": (1, -1, 0, 1.0), "s": (1, 0, 0, 0.7), "b": (0, 0, 0, 0.7)},
             "m*v**2*log(1 + (q1**2 + q2**2/b**2)/s**2)/2",
             ["-m*v**2*q1/(s**2 + q1**2 + q2**2/b**2)",
              "-m*v**2*q2/b**2/(s**2 + q1**2 + q2**2/b**2)"], *_ORBITS),
        _two("yukawa", {"A": (3, -2, 1, 1.5), "s": (1, 0, 0, 2.0)}, f"-A*exp(-{_R}/s)/{_R}",
             [f"-A*exp(-{_R}/s)*(1/{_R} + 1/s)*q1/{_R}**2",
              f"-A*exp(-{_R}/s)*(1/{_R} + 1/s)*q2/{_R}**2"], *_ORBITS),
        _two("toda", {"D": _ENERGY, "a": (-1, 0, 0, 0.8)},
             "D*(exp(a*q1) + exp(a*(q2 - q1)) + exp(-a*q2))",
             ["-D*a*(exp(a*q1) - exp(a*(q2 - q1)))",
              "-D*a*(exp(a*(q2 - q1)) - exp(-a*q2))"], *_WELLS),
        System("two-bodies", {"m": (0, 0, 1, 1.0), "M": (0, 0, 1, 3.0), "G": (3, -2, -1, 0.5)},
               "(p1**2 + p2**2)/(2*m) + (p3**2 + p4**2)/(2*M)", f"-G*m*M/{_D}",
               ["p1/m", "p2/m", "p3/M", "p4/M"],
               [f"-G*m*M*(q1 - q3)/{_D}**3", f"-G*m*M*(q2 - q4)/{_D}**3",
                f"G*m*M*(q1 - q3)/{_D}**3", f"G*m*M*(q2 - q4)/{_D}**3"],
               [(0.1, 1.1, 0.2, -0.9, 0.9, -0.2, -0.3, 0.1),
                (-0.7, 0.6, 0.4, -0.5, 0.5, 0.9, -0.2, -0.4)]),
        System("chain", {"m": _MASS, "k": _SPRING, "b": (-2, -2, 1, 1.0)},
               "(p1**2 + p2**2 + p3**2)/(2*m)",
               "k*(q1**2 + (q2 - q1)**2 + (q3 - q2)**2 + q3**2)/2"
               " + b*(q1**4 + (q2 - q1)**4 + (q3 - q2)**4 + q3**4)/4",
               ["p1/m", "p2/m", "p3/m"],
               ["-k*(2*q1 - q2) - b*(q1**3 - (q2 - q1)**3)",
                "-k*(2*q2 - q1 - q3) - b*((q2 - q1)**3 - (q3 - q2)**3)",
                "-k*(2*q3 - q2) - b*((q3 - q2)**3 + q3**3)"],
               [(0.4, 0.3, -0.2, 0.2, -0.5, 0.3), (-0.3, 0.5, 0.1, -0.4, 0.3, 0.6)]),
    )
}  # fmt: skip
